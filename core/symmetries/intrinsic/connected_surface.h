#pragma once

#include <symsurf/context.h>
#include <symsurf/points.h>

#include <vector>

#include "cloud/laplacian.h"

namespace symsurf {

/// A connected surface of distinct points, as a mesh or a cloud gives it, with its Laplacian.
struct ConnectedSurface {
  Points points;
  Laplacian laplacian;  ///< areas add up to 1, eigenvalues are in their unit
  Index parts = 0;      ///< of the input that do not touch
  double share = 0;     ///< of the area of all in this one
};

/// The part of the input that has the most area. Equal points are merged, parts joined where they
/// are about as near each other as neighbouring vertices; without faces the points are a cloud.
/// Throws InvalidInput where nothing has an area.
ConnectedSurface connected_surface(PointsView points, TrianglesView faces, const Context& context);

/// Lengths of the shortest ways along edges of the Laplacian from a vertex to all (Dijkstra 1959).
Eigen::VectorXd edge_distances(const ConnectedSurface& surface, Index from);

/// The first eigenfunctions of the Laplacian of a surface, but for the constant one.
struct SurfaceBasis {
  Eigen::VectorXd values;     ///< ascending, times the area of the surface
  Eigen::MatrixXd functions;  ///< one a column, their squares 1 in the mean
  Index count() const { return values.size(); }
};

SurfaceBasis surface_basis(const ConnectedSurface& surface, Index count, const Context& context);

/// Removes the links of a cloud's surface along which eigenfunctions rise much more steeply than
/// elsewhere, as where a hand touches a leg: ways along the surface no longer lead through there.
/// Those that hold it together stay.
void part_contacts(const SurfaceBasis& basis, ConnectedSurface& surface);

/// Vertices far from each other, to compare maps at.
struct SampledPoints {
  std::vector<Index> vertices;
  Eigen::VectorXd weights;     ///< the area nearest to each along edges; their sum is 1
  Eigen::MatrixXd distances;   ///< between them along edges, in the longest of these
  Eigen::MatrixXd to_all;      ///< the same to all vertices, a row a vertex
  std::vector<Index> nearest;  ///< of each vertex the nearest, by its position among them

  double longest = 0;  ///< in the unit of the surface

  Index count() const { return weights.size(); }
};

SampledPoints surface_samples(const ConnectedSurface& surface, Index count, const Context& context);

}  // namespace symsurf
