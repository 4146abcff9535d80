#pragma once

#include <cstdint>
#include <vector>

#include "cloud/surfels.h"

namespace symsurf {

/// Which surfel lies nearest to any position, to half a cell: one look-up instead of a search.
class SurfelMap {
 public:
  explicit SurfelMap(const Surfels& surfels);

  /// The surfel nearest to x, or -1 when none lies within about a cell and a half of it.
  Index nearest(const Vector3& x) const {
    const Vector3 at = (x - origin_) * cells_;
    if (!((at.array() >= 0).all() && (at.array() < end_.array()).all())) return -1;
    return near_[linear(at.cast<int>())];
  }

 private:
  Index linear(const Eigen::Vector3i& c) const {
    return (static_cast<Index>(c.x()) * size_.y() + c.y()) * size_.z() + c.z();
  }

  Vector3 origin_, end_;
  double cells_;  // along a unit of length
  Eigen::Vector3i size_;
  std::vector<std::int32_t> near_;
};

}  // namespace symsurf
