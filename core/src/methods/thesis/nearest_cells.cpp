#include "methods/thesis/nearest_cells.h"

#include <algorithm>
#include <cmath>

#include "base/infinity.h"
#include "spatial/point_tree.h"

namespace symsurf {

namespace {

// Far from its points a cloud may have one more: cells of a part of the reach would not end.
constexpr double most_cells = 1 << 21;

}  // namespace

NearestCells::NearestCells(PointsView points, double reach, const Context& context)
    : points_(points) {
  const Vector3 low = points.matrix().colwise().minCoeff();
  const Vector3 extent = Vector3(points.matrix().colwise().maxCoeff()) - low;
  cell_ = std::max(reach / 3, std::cbrt((extent.array() + 2 * reach).prod() / most_cells));
  inverse_cell_ = 1 / cell_;
  const double margin = reach + 2 * cell_;  // the outermost cells list nothing
  low_ = low.array() - margin;
  size_ = ((extent.array() + 2 * margin) / cell_).ceil().cast<int>() + 1;
  last_ = (size_ - 1).cast<double>();

  const PointTree tree(points);
  const double half_diagonal = std::sqrt(3.0) / 2 * cell_ * (1 + 1e-9);
  start_.push_back(0);
  for (int x = 0; x < size_.x(); ++x)
    for (int y = 0; y < size_.y(); ++y) {
      context.check();
      for (int z = 0; z < size_.z(); ++z) {
        const Vector3 centre = low_ + cell_ * (Vector3(x, y, z).array() + 0.5).matrix();
        const double farthest = reach + half_diagonal;
        const Neighbour nearest = tree.nearest(centre, farthest * farthest);
        // Any place in the cell is nearer to that point than this to the centre.
        if (nearest.index >= 0)
          tree.within(centre, std::sqrt(nearest.squared_distance) + 2 * half_diagonal,
                      [&](Index i, double) { listed_.push_back(static_cast<std::int32_t>(i)); });
        start_.push_back(static_cast<std::int32_t>(listed_.size()));
      }
    }
}

double NearestCells::squared(Index cell, const Vector3& x) const {
  double best = infinity;
  for (std::int32_t k = start_[cell]; k < start_[cell + 1]; ++k)
    best = std::min(best, (points_[listed_[k]] - x).squaredNorm());
  return best;
}

double NearestCells::least_squared(Index cell) const {
  const Index column = cell / size_.z();
  const Vector3 corner(static_cast<double>(column / size_.y()),
                       static_cast<double>(column % size_.y()),
                       static_cast<double>(cell % size_.z()));
  // Rounding may put places of another cell's edge here.
  const Vector3 low = low_ + cell_ * (corner.array() - 1e-9).matrix(),
                high = low + Vector3::Constant(cell_ * (1 + 2e-9));
  double least = infinity;
  for (std::int32_t k = start_[cell]; k < start_[cell + 1]; ++k) {
    const Vector3 point = points_[listed_[k]];
    least = std::min(least, (point.cwiseMax(low).cwiseMin(high) - point).squaredNorm());
  }
  return least;
}

}  // namespace symsurf
