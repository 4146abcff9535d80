#include "spatial/point_tree.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <numeric>
#include <utility>

#include "base/math.h"
#include "base/parallel.h"
#include "base/radix_sort.h"

namespace symsurf {

namespace {

constexpr int bits_per_axis = 21;

// Spreads the low 21 bits of v to every third bit.
std::uint64_t spread(std::uint64_t v) {
  v &= 0x1fffff;
  v = (v | v << 32) & 0x1f00000000ffff;
  v = (v | v << 16) & 0x1f0000ff0000ff;
  v = (v | v << 8) & 0x100f00f00f00f00f;
  v = (v | v << 4) & 0x10c30c30c30c30c3;
  return (v | v << 2) & 0x1249249249249249;
}

}  // namespace

PointTree::PointTree(PointsView points, const Context& context) {
  Eigen::AlignedBox3d box;
  Index finite = 0;
  for (Index i = 0; i < points.size(); ++i)
    if (points[i].allFinite()) {
      box.extend(points[i]);
      ++finite;
    }
  if (finite > 0) origin_ = box.min() / 2 + box.max() / 2;  // their sum may be no double
  sort(points, finite > 0 ? box.sizes().maxCoeff() : 0, context);
  context.report(0.5);

  if (finite == 0) return;
  std::vector<Vector3> sorted(finite);
  interruptible_for(context, finite, [&](Index p) { sorted[p] = points[order_[p]] - origin_; });
  tree_ = std::make_unique<const Tree>(std::move(sorted), context);
}

void PointTree::sort(PointsView points, double extent, const Context& context) {
  const double cells = static_cast<double>(1 << bits_per_axis) - 1;
  constexpr double least = 1e-300;  // an extent, in input units, that cells can be divided by
  const double scale = extent > least ? cells / extent : 0;
  const Vector3 to_cells = Vector3::Constant(cells / 2);
  std::vector<std::uint64_t> keys(points.size());
  interruptible_for(context, points.size(), [&](Index i) {
    if (!points[i].allFinite()) {
      keys[i] = std::uint64_t{1} << (3 * bits_per_axis);
      return;
    }
    const Vector3 cell = (points[i] - origin_) * scale + to_cells;
    const auto at = [&](int axis) {
      return spread(static_cast<std::uint64_t>(std::clamp(cell[axis], 0.0, cells)));
    };
    keys[i] = at(0) << 2 | at(1) << 1 | at(2);
  });
  order_.resize(keys.size());
  std::iota(order_.begin(), order_.end(), 0);
  radix_sort(keys, order_, context);
}

Neighbour PointTree::nearest(const Vector3& query, double limit) const {
  Neighbour best;
  search(query, limit, [&](const Neighbour& found) {
    if (found.squared_distance <= limit && found < best) {
      best = found;
      limit = found.squared_distance;
    }
    return limit;
  });
  return best;
}

void PointTree::nearest(const Vector3& query, Index k, std::vector<Neighbour>& found) const {
  found.clear();
  const auto wanted = static_cast<std::size_t>(k);
  search(query, infinity, [&](const Neighbour& neighbour) {
    keep_best(found, wanted, neighbour);
    return found.size() < wanted ? infinity : found.back().squared_distance;
  });
}

}  // namespace symsurf
