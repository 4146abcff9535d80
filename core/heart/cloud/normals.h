#pragma once

#include <symsurf/context.h>
#include <symsurf/points.h>

#include <functional>
#include <vector>

#include "cloud/point_tree.h"

namespace symsurf {

/// How a cloud lies around one of its points: its nearest others, of a weight that falls with the
/// distance as 1 - (d / radius)^2. Which of several as far as the last are counted does not matter.
struct NeighbourhoodMoments {
  double radius = 0;                     ///< how far the last lies
  Vector3 mean = Vector3::Zero();        ///< from the point, in radii
  Matrix3 covariance = Matrix3::Zero();  ///< in radii squared

  /// 0: as many on all sides; 5/16 at the flat face of a body full of points.
  double one_sided() const { return mean.norm(); }
};

/// Calls visit(v, moments of the k nearest others of the point tree.order()[positions[v]]) for
/// all of the positions, on several threads at once; fastest where they ascend.
void visit_neighbourhoods(
    PointsView points, const PointTree& tree, Index k, const std::vector<Index>& positions,
    const Context& context,
    const std::function<void(Index v, const NeighbourhoodMoments& around)>& visit);

/// estimate_normals() of points whose tree is there already.
Points estimate_normals(PointsView points, const PointTree& tree, Index neighbours,
                        std::string_view method, const Context& context);

}  // namespace symsurf
