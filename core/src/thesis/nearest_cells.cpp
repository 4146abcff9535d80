#include "nearest_cells.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "../point_tree.h"

namespace symsurf {

NearestCells::NearestCells(PointsView points, double reach) : points_(points), cell_(reach / 3) {
  const Vector3 margin = Vector3::Constant(reach);
  low_ = Vector3(points.matrix().colwise().minCoeff()) - margin;
  const Vector3 high = Vector3(points.matrix().colwise().maxCoeff()) + margin;
  size_ = ((high - low_) / cell_).array().ceil().cast<int>() + 1;

  const PointTree tree(points);
  const double half_diagonal = std::sqrt(3.0) / 2 * cell_ * (1 + 1e-9);
  start_.push_back(0);
  for (int x = 0; x < size_.x(); ++x)
    for (int y = 0; y < size_.y(); ++y)
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

double NearestCells::squared(const Vector3& x) const {
  double best = std::numeric_limits<double>::infinity();
  const Eigen::Array3d at = (x - low_).array() / cell_;
  if (!((at >= 0).all() && (at < size_.cast<double>()).all())) return best;
  const Eigen::Array3i c = at.cast<int>();
  const Index cell = (static_cast<Index>(c.x()) * size_.y() + c.y()) * size_.z() + c.z();
  for (std::int32_t k = start_[cell]; k < start_[cell + 1]; ++k)
    best = std::min(best, (points_[listed_[k]] - x).squaredNorm());
  return best;
}

}  // namespace symsurf
