#pragma once

#include <symsurf/types.h>

namespace symsurf {

/// Cubic cells over a box, numbered along z, then y, then x.
class Cells {
 public:
  using Cell = Eigen::Vector3i;

  Cells() = default;

  Cells(const Vector3& low, const Vector3& high, double edge)
      // Off any lattice that the points may lie on: rounding must not decide between two cells.
      : low_(low.array() - 0.38197 * edge),
        edge_(edge),
        cells_(1 / edge),
        size_(((high - low_) * cells_).array().floor().cast<int>() + 1) {}

  double edge() const { return edge_; }
  const Vector3& low() const { return low_; }

  Index count() const { return size_.cast<Index>().prod(); }

  /// Of points beside the box the nearest.
  Cell cell_of(const Vector3& x) const {
    return ((x - low_) * cells_).cast<int>().cwiseMax(0).cwiseMin(size_ - Cell::Ones());
  }
  Vector3 middle(const Cell& c) const {
    return low_ + edge_ * (c.cast<double>().array() + 0.5).matrix();
  }

  bool covers(const Vector3& x) const {
    const Vector3 at = (x - low_) * cells_;
    // Points on the far faces belong to the last cell, as in cell_of.
    return (at.array() >= 0).all() && (at.array() <= size_.cast<double>().array()).all();
  }

  Index number(const Cell& c) const {
    return (static_cast<Index>(c.x()) * size_.y() + c.y()) * size_.z() + c.z();
  }
  Cell numbered(Index number) const {
    const Index row = number / size_.z();
    return Vector3(row / size_.y(), row % size_.y(), number % size_.z()).cast<int>();
  }

  /// Calls visit(begin, end) for the rows of numbers of this cell and those that touch it.
  template <typename Visit>
  void for_each_row_touching(const Cell& c, const Visit& visit) const {
    const Cell from = (c.array() - 1).max(0), to = (c.array() + 1).min(size_.array() - 1);
    for (int x = from.x(); x <= to.x(); ++x)
      for (int y = from.y(); y <= to.y(); ++y) {
        const Index row = number({x, y, 0});
        visit(row + from.z(), row + to.z() + 1);
      }
  }

 private:
  Vector3 low_ = Vector3::Zero();
  double edge_ = 1, cells_ = 1;  // cells along a unit of length
  Cell size_ = Cell::Zero();
};

}  // namespace symsurf
