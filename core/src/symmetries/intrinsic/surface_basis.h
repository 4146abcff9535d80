#pragma once

#include <symsurf/context.h>

#include <vector>

#include "symmetries/intrinsic/connected_surface.h"

namespace symsurf {

/// The first eigenfunctions of the Laplacian of a surface, but for the constant one.
struct SurfaceBasis {
  Eigen::VectorXd values;     ///< ascending, times the area of the surface
  Eigen::MatrixXd functions;  ///< one a column, their squares 1 in the mean
  Index count() const { return values.size(); }
};

SurfaceBasis surface_basis(const ConnectedSurface& surface, Index count, const Context& context);

/// Vertices far from each other, to compare functions at.
struct SampledPoints {
  std::vector<Index> vertices;
  Eigen::VectorXd weights;    ///< the area nearest to each along edges; their sum is 1
  Eigen::MatrixXd distances;  ///< between them along edges, in the longest; where these were asked
};

SampledPoints surface_samples(const ConnectedSurface& surface, Index count, const Context& context);

}  // namespace symsurf
