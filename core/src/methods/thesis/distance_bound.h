#pragma once

#include <symsurf/context.h>
#include <symsurf/points_view.h>

#include <vector>

namespace symsurf {

/// A lower bound on the distance of any place from a cloud, in one look-up: the distance between
/// the place's cell of a grid and the nearest occupied cell (Felzenszwalb and Huttenlocher,
/// "Distance transforms of sampled functions", 2012). About two cells a point.
class DistanceBound {
 public:
  DistanceBound(PointsView points, const Context& context);

  /// Of a place inside the cloud's bounding box.
  double operator()(const Vector3& x) const {
    const Eigen::Array3i c = ((x - low_) / cell_).array().max(0).cast<int>().min(size_ - 1);
    return bound_[index(c)];
  }

  /// Edge of a cell.
  double cell() const { return cell_; }

 private:
  Index index(const Eigen::Array3i& c) const {
    return (static_cast<Index>(c.x()) * size_.y() + c.y()) * size_.z() + c.z();
  }

  Vector3 low_;
  double cell_ = 1;
  Eigen::Array3i size_;
  std::vector<float> bound_;
};

}  // namespace symsurf
