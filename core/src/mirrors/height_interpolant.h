#pragma once

#include <symsurf/points_view.h>

#include <vector>

#include "spatial/point_tree.h"

namespace symsurf {

/// Heights over the plane through scattered nodes: the modified quadratic Shepard interpolant of
/// Renka (1988), with the nearest nodes in place of a fixed radius of influence.
class HeightInterpolant {
 public:
  /// Rows (u, v, height), at least one. Nodes at the same position: the first counts.
  explicit HeightInterpolant(const Points& nodes);

  double operator()(const Eigen::Vector2d& at) const;

 private:
  /// height + slope . d + d' curvature d / 2, continued by its tangent beyond `reach`.
  struct Quadratic {
    double height = 0;
    Eigen::Vector2d slope = Eigen::Vector2d::Zero();
    Eigen::Vector3d curvature = Eigen::Vector3d::Zero();  ///< uu, uv, vv
    double reach = 0;

    double operator()(const Eigen::Vector2d& d) const;
  };

  Quadratic fitted(Index node, const std::vector<Neighbour>& around) const;

  Points nodes_;
  PointTree tree_;  // of the nodes at height 0
  std::vector<Quadratic> quadratics_;
};

}  // namespace symsurf
