#pragma once

#include <vector>

#include "cloud/cloud.h"
#include "spatial/point_tree.h"

namespace symsurf {

/// The cloud as the search for a fixed direction sees it: actual points in the principal frame,
/// in the order of a space-filling curve there, so that nothing depends on pose, unit or order.
struct WorkingCloud {
  /// All points, or `count` of them spread over the cloud.
  WorkingCloud(const Points& framed, Index count, const Context& context = Context(nullptr, 1));

  Index size() const { return points.rows(); }
  Vector3 point(Index i) const { return points.row(i).transpose(); }
  Vector3 normal(Index i) const { return normals.row(i).transpose(); }

  std::vector<Index> rows;  ///< of the given points
  Points points;
  PointTree tree;            ///< of these points
  Points normals;            ///< unit, sign arbitrary; of the local regression plane
  Eigen::VectorXd flatness;  ///< distance from that plane, RMS
  Eigen::VectorXd spacings;  ///< of the points on a surface, about each point
  double spacing = 0;        ///< median of them
};

}  // namespace symsurf
