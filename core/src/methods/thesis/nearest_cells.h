#pragma once

#include <symsurf/context.h>
#include <symsurf/points_view.h>

#include <algorithm>
#include <cstdint>
#include <vector>

namespace symsurf {

/// Distances to the nearest of a few hundred points in a look-up: a grid whose cells list the
/// points that are nearest to some place inside, as far as `reach`.
class NearestCells {
 public:
  NearestCells(PointsView points, double reach, const Context& context = {});

  /// The cell where x lies, or one that lists nothing where x is NaN or outside of all.
  Index cell(const Vector3& x) const {
    // A branch for what lies outside could not be foretold. NaN is not above 0, and so 0.
    const Eigen::Array3d at = (x - low_).array() * inverse_cell_;
    const auto place = [&](int k) {
      return static_cast<std::int32_t>(std::min(std::max(0.0, at[k]), last_[k]));
    };
    return (static_cast<Index>(place(0)) * size_.y() + place(1)) * size_.z() + place(2);
  }

  Index cell_count() const { return static_cast<Index>(start_.size()) - 1; }

  /// Squared distance of x, which lies in that cell, from the nearest point; infinite where that
  /// may be beyond reach.
  double squared(Index cell, const Vector3& x) const;

  /// What `squared` is at the least anywhere in the cell.
  double least_squared(Index cell) const;

 private:
  PointsView points_;
  Vector3 low_;
  double cell_, inverse_cell_;
  Eigen::Array3i size_;
  Eigen::Array3d last_;  // size_ - 1
  std::vector<std::int32_t> start_, listed_;
};

}  // namespace symsurf
