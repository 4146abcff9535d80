#pragma once

#include <symsurf/context.h>
#include <symsurf/points_view.h>

#include <cstdint>
#include <vector>

namespace symsurf {

/// Tells of most places that no point of a cloud is close, in one look-up: a bit for each fine cell
/// within reach of a point, in a hash table that takes 4 to 8 bytes a point.
class CloseCells {
 public:
  /// Cells of edge 4 reach.
  CloseCells(PointsView points, double reach, const Context& context);

  double reach() const { return reach_; }

  /// False: no point is within reach of a place inside the cloud's bounding box.
  bool may_hold(const Vector3& x) const {
    const std::uint64_t bit = hash(cell_of(x));
    return bits_[bit / 64] >> bit % 64 & 1;
  }

 private:
  using Cell = Eigen::Array<std::int64_t, 3, 1>;

  Cell cell_of(const Vector3& x) const {
    return ((x - low_) / cell_).array().floor().cast<std::int64_t>();
  }
  std::uint64_t hash(const Cell& c) const {
    const auto part = [](std::int64_t i, std::uint64_t odd) {
      return static_cast<std::uint64_t>(i) * odd;
    };
    return (part(c.x(), 0x9e3779b97f4a7c15) + part(c.y(), 0xc2b2ae3d27d4eb4f) +
            part(c.z(), 0x165667b19e3779f9)) >>
           shift_;
  }

  Vector3 low_;
  double reach_, cell_;
  int shift_;  // keeps as many bits of a hash as the table has
  std::vector<std::uint64_t> bits_;
};

}  // namespace symsurf
