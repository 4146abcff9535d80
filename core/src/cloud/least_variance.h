#pragma once

#include <array>
#include <vector>

#include "spatial/point_tree.h"

namespace symsurf {

/// Eight neighbourhoods side by side, one a lane: of each the offsets of its points from one amid
/// them, point by point x, y and z.
class Neighbourhoods {
 public:
  static constexpr int lanes = PointTree::block;
  using Lanes = std::array<double, lanes>;

  explicit Neighbourhoods(Index points) : offsets_(3 * points) {}

  void set(int lane, Index point, const Vector3& offset) {
    for (int axis = 0; axis < 3; ++axis) offsets_[3 * point + axis][lane] = offset[axis];
  }

  /// Of one of them, row by row.
  Points offsets(int lane) const;

  /// The directions of least variance: unit vectors, column by column, to the rounding of their
  /// scatter matrices (Jacobi's method: Golub and Van Loan, "Matrix Computations", 8.5).
  Eigen::Matrix<double, 3, lanes> least_variance() const;

 private:
  std::vector<Lanes> offsets_;
};

}  // namespace symsurf
