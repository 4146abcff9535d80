#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "spatial/point_tree.h"

namespace symsurf {

/// Exact nearest neighbours in a small cloud, several times as fast as PointTree: the points in the
/// cells of a uniform grid, a row of cells one run of points (Bentley, Weide and Yao 1980).
class PointGrid {
 public:
  /// Of at least one point.
  explicit PointGrid(PointsView points);

  /// The grid of a cloud that is small enough to stay in cache and nowhere crowded; none where a
  /// tree is faster.
  static std::optional<PointGrid> where_faster(PointsView points);

  /// What PointTree::nearest gives.
  Neighbour nearest(const Vector3& query, double limit) const { return best<1>(query, limit)[0]; }

  /// The two nearest; index -1 where there are fewer.
  std::array<Neighbour, 2> two_nearest(const Vector3& query) const;

 private:
  using Cell = Eigen::Array3i;

  void choose_cell(PointsView points);
  void fill(PointsView points);
  Cell cell_of(const Vector3& x) const;
  Index linear(const Cell& c) const {
    return (static_cast<Index>(c.z()) * size_.y() + c.y()) * size_.x() + c.x();
  }

  // Calls body(begin, end) of the points of these cells, run by run.
  template <typename Body>
  void each_run(const Cell& from, const Cell& to, const Body& body) const;
  bool nearest_of_cells(const Cell& from, const Cell& to, const Vector3& query,
                        Neighbour& found) const;
  template <std::size_t k>
  std::array<Neighbour, k> best(const Vector3& query, double limit) const;

  Vector3 low_, high_;
  double cell_ = 1, cells_ = 1;  // edge of a cell, cells along a unit of length
  Cell size_ = Cell::Ones();
  std::vector<std::int32_t> start_, order_;
  std::vector<Vector3> points_;  // cell by cell
  Index fullest_ = 0;
};

}  // namespace symsurf
