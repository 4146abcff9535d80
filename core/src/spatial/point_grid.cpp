#include "spatial/point_grid.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "spatial/occupied_cells.h"

namespace symsurf {

namespace {

// The nearest so far, nearest first; those of index -1 are as far as any may be.
template <std::size_t k>
void keep(std::array<Neighbour, k>& found, const Neighbour& neighbour) {
  Neighbour& last = found.back();
  if (neighbour.squared_distance > last.squared_distance) return;
  if (last.index >= 0 && !(neighbour < last)) return;
  last = neighbour;
  if constexpr (k == 2)
    if (found[0].index < 0 || found[1] < found[0]) std::swap(found[0], found[1]);
}

}  // namespace

PointGrid::PointGrid(PointsView points)
    : low_(points.matrix().colwise().minCoeff()), high_(points.matrix().colwise().maxCoeff()) {
  choose_cell(points);
  fill(points);
}

std::optional<PointGrid> PointGrid::where_faster(PointsView points) {
  constexpr Index small_cloud = 20'000, crowded = 64;  // points; points in a cell
  if (points.empty() || points.size() > small_cloud) return std::nullopt;
  PointGrid grid(points);
  if (grid.fullest_ > crowded) return std::nullopt;
  return grid;
}

// Cells that hold a few points where they hold any. Sheets fill cells as the square of the cell's
// length, so a guess and a correction are enough.
void PointGrid::choose_cell(PointsView points) {
  constexpr double wanted = 4, most_cells = 32;  // points in a cell; cells a point
  const double longest = (high_ - low_).maxCoeff();
  const double count = static_cast<double>(points.size());
  if (!(longest > 0)) return;
  const auto set = [&](double cell) {
    const double volume = (high_ - low_).cwiseMax(cell).prod();
    cell_ = std::max({cell, std::cbrt(volume / (most_cells * count)), 1e-3 * longest});
    cells_ = 1 / cell_;
    size_ = ((high_ - low_) * cells_).array().floor().cast<int>() + 1;
  };
  set(2 * longest / std::sqrt(count));
  OccupiedCells occupied(size_.cast<Index>().prod());
  for (Index i = 0; i < points.size(); ++i) occupied.add(linear(cell_of(points[i])));
  occupied.number_them();
  set(cell_ * std::sqrt(wanted * static_cast<double>(occupied.count()) / count));
}

void PointGrid::fill(PointsView points) {
  std::vector<std::int32_t> cells(points.size());
  start_.assign(static_cast<std::size_t>(size_.cast<Index>().prod()) + 1, 0);
  for (Index i = 0; i < points.size(); ++i) {
    cells[i] = static_cast<std::int32_t>(linear(cell_of(points[i])));
    fullest_ = std::max<Index>(fullest_, ++start_[cells[i] + 1]);
  }
  std::partial_sum(start_.begin(), start_.end(), start_.begin());
  std::vector<std::int32_t> next(start_.begin(), start_.end() - 1);
  order_.resize(points.size());
  points_.resize(points.size());
  for (Index i = 0; i < points.size(); ++i) {
    const std::int32_t place = next[cells[i]]++;
    order_[place] = static_cast<std::int32_t>(i);
    points_[place] = points[i];
  }
}

PointGrid::Cell PointGrid::cell_of(const Vector3& x) const {
  // Clamped while still double: a query may be anywhere.
  const Eigen::Array3d cell = ((x - low_) * cells_).array();
  return cell.max(0.0).min((size_ - 1).cast<double>()).cast<int>();
}

template <typename Body>
void PointGrid::each_run(const Cell& from, const Cell& to, const Body& body) const {
  for (int z = from.z(); z <= to.z(); ++z)
    for (int y = from.y(); y <= to.y(); ++y) {
      const Index row = linear({0, y, z});
      body(start_[row + from.x()], start_[row + to.x() + 1]);
    }
}

// Without a branch a point, which no processor foresees: false where two are as near, and which of
// them is meant was not looked at.
bool PointGrid::nearest_of_cells(const Cell& from, const Cell& to, const Vector3& query,
                                 Neighbour& found) const {
  // As far as found may be, and found again then, is no tie.
  double least = std::nextafter(found.squared_distance, std::numeric_limits<double>::infinity());
  std::int32_t place = -1;
  bool tied = false;
  each_run(from, to, [&](std::int32_t begin, std::int32_t end) {
    for (std::int32_t p = begin; p < end; ++p) {
      const double squared = (points_[p] - query).squaredNorm();
      tied |= squared == least;
      place = squared < least ? p : place;
      least = squared < least ? squared : least;
    }
  });
  if (tied) return false;
  if (place >= 0) found = {order_[place], least};
  return true;
}

// Looks at all cells within a reach of the query, and again with a longer reach where it was too
// short to be sure.
template <std::size_t k>
std::array<Neighbour, k> PointGrid::best(const Vector3& query, double limit) const {
  std::array<Neighbour, k> found;
  if (!query.allFinite()) return found;
  constexpr double first_look = 0.45, rounding = 1e-9;  // of a cell
  const Eigen::Array3d last = (size_ - 1).cast<double>(), at = (query - low_).array() * cells_;
  const double farthest = std::sqrt(limit);
  for (double reach = first_look * cell_;;) {
    reach = std::min(reach, farthest);
    found.fill({-1, limit});
    const double width = reach * cells_ + rounding;
    const Cell from = (at - width).max(0.0).min(last).cast<int>();
    const Cell to = (at + width).max(0.0).min(last).cast<int>();
    if (k > 1 || !nearest_of_cells(from, to, query, found[0]))
      each_run(from, to, [&](std::int32_t begin, std::int32_t end) {
        for (std::int32_t p = begin; p < end; ++p)
          keep(found, {order_[p], (points_[p] - query).squaredNorm()});
      });
    if (found.back().index >= 0) {
      limit = found.back().squared_distance;
      const double distance = std::sqrt(limit);
      if (distance <= reach) return found;
      reach = distance;
    } else {
      if (reach >= farthest || (to - from + 1 == size_).all()) return found;
      reach *= 2;
    }
  }
}

std::array<Neighbour, 2> PointGrid::two_nearest(const Vector3& query) const {
  return best<2>(query, std::numeric_limits<double>::infinity());
}

template std::array<Neighbour, 1> PointGrid::best<1>(const Vector3&, double) const;

}  // namespace symsurf
