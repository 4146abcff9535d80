#pragma once

#include <symsurf/types.h>

#include "../occupied_cells.h"

namespace symsurf {

/// Cubic cells over a box, those that are occupied numbered in their order.
class CellGrid {
 public:
  using Cell = Eigen::Vector3i;

  CellGrid() = default;

  CellGrid(const Vector3& low, const Vector3& high, double edge)
      // Off any lattice that the points may lie on: rounding must not decide between two cells.
      : low_(low.array() - 0.38197 * edge),
        edge_(edge),
        cells_(1 / edge),
        size_(((high - low_) * cells_).array().floor().cast<int>() + 1) {
    clear();
  }

  /// The cells' edge.
  double edge() const { return edge_; }
  const Vector3& low() const { return low_; }

  /// Of points beside the box the nearest.
  Cell cell_of(const Vector3& x) const {
    return ((x - low_) * cells_).cast<int>().cwiseMax(0).cwiseMin(size_ - Cell::Ones());
  }
  Vector3 middle(const Cell& c) const {
    return low_ + edge_ * (c.cast<double>().array() + 0.5).matrix();
  }

  void clear() { occupied_ = OccupiedCells(size_.cast<Index>().prod()); }
  void occupy(const Cell& c) { occupied_.add(linear(c)); }
  void occupy(const OccupiedCells::Words& of_another) { occupied_.add(of_another); }
  const OccupiedCells::Words& words() const { return occupied_.words(); }

  /// To be called when all are occupied, and before any is asked for.
  void number_them() { occupied_.number_them(); }

  Index count() const { return occupied_.count(); }

  /// -1: not occupied.
  Index number(const Cell& c) const { return occupied_.number(linear(c)); }

  /// Of the cell that holds x; -1 where that is not occupied, or x beside the box.
  Index number_at(const Vector3& x) const {
    const Vector3 at = (x - low_) * cells_;
    // Points on the far faces belong to the last cell, as in cell_of.
    if (!((at.array() >= 0).all() && (at.array() <= size_.cast<double>().array()).all())) return -1;
    return number(cell_of(x));
  }

  /// Calls visit(number) for the occupied cells that touch this one, and itself if it is.
  template <typename Visit>
  void for_each_touching(const Cell& c, const Visit& visit) const {
    const Cell from = (c.array() - 1).max(0), to = (c.array() + 1).min(size_.array() - 1);
    for (int x = from.x(); x <= to.x(); ++x)
      for (int y = from.y(); y <= to.y(); ++y) {
        const Index row = linear({x, y, 0}), end = occupied_.before(row + to.z() + 1);
        for (Index k = occupied_.before(row + from.z()); k < end; ++k) visit(k);
      }
  }

 private:
  Index linear(const Cell& c) const {
    return (static_cast<Index>(c.x()) * size_.y() + c.y()) * size_.z() + c.z();
  }

  Vector3 low_ = Vector3::Zero();
  double edge_ = 1, cells_ = 1;  // cells along a unit of length
  Cell size_ = Cell::Zero();
  OccupiedCells occupied_;
};

}  // namespace symsurf
