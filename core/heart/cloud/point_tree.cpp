#include "cloud/point_tree.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <limits>
#include <numeric>
#include <tuple>
#include <utility>

#include "base/math.h"
#include "base/parallel.h"
#include "base/radix_sort.h"
#include "cloud/cloud.h"

namespace symsurf {

namespace {

constexpr int bits_per_axis = 21;
constexpr std::uint64_t key_of_nonfinite = std::uint64_t{1} << (3 * bits_per_axis);  // the last

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
  std::vector<std::uint64_t> keys = sort(points, finite > 0 ? box.sizes().maxCoeff() : 0, context);
  context.report(0.5);

  if (finite == 0) return;
  std::vector<Vector3> sorted(begins_.empty() ? finite : begins_.size() - 1);
  interruptible_for(context, static_cast<Index>(sorted.size()), [&](Index node) {
    sorted[node] = points[order_[begin(node)]] - origin_;
    keys[node] = keys[begin(node)];  // of the first of copies
  });
  keys.resize(sorted.size());
  tree_ = std::make_unique<const Tree>(std::move(sorted), keys, context);
}

std::vector<std::uint64_t> PointTree::sort(PointsView points, double extent,
                                           const Context& context) {
  constexpr Index grain = 1 << 14;  // points that a thread takes at a time
  const double cells = static_cast<double>(1 << bits_per_axis) - 1;
  constexpr double least = 1e-300;  // an extent, in input units, that cells can be divided by
  const double scale = extent > least ? cells / extent : 0;
  const Vector3 to_cells = Vector3::Constant(cells / 2);
  std::vector<std::uint64_t> keys(points.size());
  const auto key_of = [&](const Vector3& x) {
    if (!x.allFinite()) return key_of_nonfinite;
    const Vector3 cell = (x - origin_) * scale + to_cells;
    const auto at = [&](int axis) {
      return spread(static_cast<std::uint64_t>(std::clamp(cell[axis], 0.0, cells)));
    };
    return at(0) << 2 | at(1) << 1 | at(2);
  };
  silent_parallel_for(context, points.size(), grain, [&](Index begin, Index end) {
    for (Index i = begin; i < end; ++i) keys[i] = key_of(points[i]);
  });
  order_.resize(keys.size());
  std::iota(order_.begin(), order_.end(), 0);
  radix_sort(keys, order_, context);
  put_copies_together(points, keys, context);
  return keys;
}

// Among points of one key, which others may stand between. `keys`: sorted.
void PointTree::put_copies_together(PointsView points, const std::vector<std::uint64_t>& keys,
                                    const Context& context) {
  const auto coordinates = [&](std::int32_t i) {
    return std::tuple(points[i].x(), points[i].y(), points[i].z());
  };
  const std::size_t finite =
      std::lower_bound(keys.begin(), keys.end(), key_of_nonfinite) - keys.begin();
  std::vector<std::int32_t> begins;
  for (std::size_t begin = 0, end; begin < finite; begin = end) {
    end = begin + 1;
    while (end < finite && keys[end] == keys[begin]) ++end;
    if (end - begin > 1) {
      context.check();
      std::stable_sort(
          order_.begin() + begin, order_.begin() + end,
          [&](std::int32_t i, std::int32_t j) { return coordinates(i) < coordinates(j); });
    }
    for (std::size_t p = begin; p < end; ++p)
      if (p == begin || points[order_[p]] != points[order_[p - 1]])
        begins.push_back(static_cast<std::int32_t>(p));
  }
  if (begins.size() == finite) return;
  begins.push_back(static_cast<std::int32_t>(finite));
  begins_ = std::move(begins);
}

Neighbour PointTree::nearest(const Vector3& query, double limit) const {
  Neighbour best;
  search(query, limit, [&](std::size_t begin, std::size_t, double squared) {
    const Neighbour found{order_[begin], squared};
    if (squared <= limit && found < best) {
      best = found;
      limit = squared;
    }
    return limit;
  });
  return best;
}

std::vector<Neighbour> PointTree::nearest(const std::vector<Vector3>& queries, double limit) const {
  std::vector<Neighbour> found(queries.size());
  if (!tree_) return found;
  std::array<Vector3, Tree::lanes> packet;
  for (std::size_t first = 0; first < queries.size(); first += packet.size()) {
    const std::size_t count = std::min(packet.size(), queries.size() - first);
    for (std::size_t i = 0; i < count; ++i) packet[i] = queries[first + i] - origin_;
    const auto positions = tree_->nearest(packet.data(), static_cast<int>(count), limit);
    for (std::size_t i = 0; i < count; ++i) {
      const std::int32_t at = positions[i];
      if (at >= 0)
        found[first + i] = {order_[begin(at)], (tree_->point(at) - packet[i]).squaredNorm()};
      else if (at < -1)
        found[first + i] = nearest(queries[first + i], limit);
    }
  }
  return found;
}

void PointTree::nearest(const Vector3& query, Index k, std::vector<Neighbour>& found) const {
  found.clear();
  const auto wanted = static_cast<std::size_t>(k);
  search(query, infinity, [&](std::size_t begin, std::size_t end, double squared) {
    for (std::size_t p = begin; p < end; ++p)
      if (!keep_best(found, wanted, Neighbour{order_[p], squared})) break;
    return found.size() < wanted ? infinity : found.back().squared_distance;
  });
}

namespace {

constexpr std::size_t queries_between_checks = 64;  // queries between two looks at the clock
const Vector3 none = Vector3::Constant(std::numeric_limits<double>::quiet_NaN());

}  // namespace

NearestPoints::NearestPoints(const Cloud& cloud, const Context& context)
    : points_(cloud.points), tree_(cloud.tree(context)), context_(context) {}

std::vector<Vector3> NearestPoints::nearest(const std::vector<Vector3>& queries,
                                            double reach) const {
  context_.check();
  std::vector<Vector3> nearest;
  nearest.reserve(queries.size());
  for (const Neighbour& found : tree_.nearest(queries, reach * reach))
    nearest.push_back(found.index < 0 ? none : points_[found.index]);
  return nearest;
}

// Duplicates of a point are one position, but several points of the tree: it takes more then.
Vector3 NearestPoints::second_nearest(const Vector3& query) const {
  constexpr Index most = 64;
  std::vector<Neighbour> near;
  for (Index k = 2;; k *= 4) {
    tree_.nearest(query, k, near);
    if (near.empty()) return none;
    const Vector3 first = points_[near.front().index];
    const auto other = std::find_if(near.begin(), near.end(), [&](const Neighbour& neighbour) {
      return points_[neighbour.index] != first;
    });
    if (other != near.end()) return points_[other->index];
    if (k >= most || static_cast<Index>(near.size()) < k) return first;
  }
}

std::vector<Vector3> NearestPoints::second_nearest(const std::vector<Vector3>& queries) const {
  std::vector<Vector3> second;
  second.reserve(queries.size());
  for (const Vector3& query : queries) {
    if (second.size() % (2 * queries_between_checks) == 0) context_.check();
    second.push_back(second_nearest(query));
  }
  return second;
}

}  // namespace symsurf
