#pragma once

#include "spatial/cells.h"
#include "spatial/occupied_cells.h"

namespace symsurf {

/// Cells over a box, those that are occupied numbered in their order.
class CellGrid {
 public:
  using Cell = Cells::Cell;

  CellGrid() = default;

  CellGrid(const Vector3& low, const Vector3& high, double edge) : cells_(low, high, edge) {
    clear();
  }

  const Cells& cells() const { return cells_; }

  void clear() { occupied_ = OccupiedCells(cells_.count()); }
  void occupy(const Cell& c) { occupied_.add(cells_.number(c)); }
  void occupy(const OccupiedCells::Words& of_another) { occupied_.add(of_another); }
  const OccupiedCells::Words& words() const { return occupied_.words(); }

  /// To be called when all are occupied, and before any is asked for.
  void number_them() { occupied_.number_them(); }

  Index count() const { return occupied_.count(); }

  /// -1: not occupied.
  Index number(const Cell& c) const { return occupied_.number(cells_.number(c)); }

  /// Of the cell that holds x; -1 where that is not occupied, or x beside the box.
  Index number_at(const Vector3& x) const {
    return cells_.covers(x) ? number(cells_.cell_of(x)) : -1;
  }

  /// Calls visit(number) for the occupied cells that touch this one, and itself if it is.
  template <typename Visit>
  void for_each_touching(const Cell& c, const Visit& visit) const {
    cells_.for_each_row_touching(c, [&](Index begin, Index end) {
      const Index last = occupied_.before(end);
      for (Index k = occupied_.before(begin); k < last; ++k) visit(k);
    });
  }

 private:
  Cells cells_;
  OccupiedCells occupied_;
};

}  // namespace symsurf
