#pragma once

#include <symsurf/context.h>
#include <symsurf/points.h>

#include <vector>

namespace symsurf {

/// Where the homologous points of a shape's points lie on its mirror image.
struct HomologousPoints {
  Points displacements;  ///< from each point to it, smooth: on the image but for what is fine
  std::vector<Index> partners;  ///< of each point the one that it is the image of; -1: not known
};

/// `images`: of the points, NaN where there are none. Without faces the points are a cloud, whose
/// surface is that of cloud_laplacian().
HomologousPoints homologous_points(PointsView points, TrianglesView faces, PointsView images,
                                   const Context& context);

}  // namespace symsurf
