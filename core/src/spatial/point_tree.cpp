#include "spatial/point_tree.h"

#include <numeric>

#include "base/binary_unit.h"
#include "base/infinity.h"
#include "base/k_best.h"
#include "base/parallel.h"
#include "base/radix_sort.h"
#include "base/vectorised.h"
#include "spatial/nearest_first.h"

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

// A run of points against a block of queries, one lane a query: x, y, z, then the best so far as
// squared distance, index and position. All are doubles, so that a lane has one width throughout.
SYMSURF_VECTORISED void scan(const double* coordinates, const std::int32_t* order, Index begin,
                             Index end, double* lanes) {
  constexpr int n = PointTree::block;
  for (int first = 0; first < n; first += doubles_wide) {
    Doubles* lane = reinterpret_cast<Doubles*>(lanes + first);
    constexpr int next = n / doubles_wide;
    const Doubles x = lane[0], y = lane[next], z = lane[2 * next];
    Doubles squared = lane[3 * next], index = lane[4 * next], position = lane[5 * next];
    for (Index p = begin; p < end; ++p) {
      const Doubles dx = x - coordinates[3 * p], dy = y - coordinates[3 * p + 1],
                    dz = z - coordinates[3 * p + 2];
      const Doubles d = dx * dx + dy * dy + dz * dz;
      const Doubles named = Doubles{} + static_cast<double>(order[p]);
      const auto nearer = (d < squared) | ((d == squared) & (named < index));
      squared = nearer ? d : squared;
      index = nearer ? named : index;
      position = nearer ? Doubles{} + static_cast<double>(p) : position;
    }
    lane[3 * next] = squared;
    lane[4 * next] = index;
    lane[5 * next] = position;
  }
}

// Squared distances of a run of points from a block of queries, query by query for each point.
SYMSURF_VECTORISED void measure(const double* coordinates, Index begin, Index end,
                                const double* queries, double* __restrict squared) {
  constexpr int n = PointTree::block;
  const double *x = queries, *y = queries + n, *z = queries + 2 * n;
  for (Index p = begin; p < end; ++p, squared += n) {
    const double px = coordinates[3 * p], py = coordinates[3 * p + 1], pz = coordinates[3 * p + 2];
    for (int i = 0; i < n; ++i) {
      const double dx = x[i] - px, dy = y[i] - py, dz = z[i] - pz;
      squared[i] = dx * dx + dy * dy + dz * dz;
    }
  }
}

// How far a neighbour may be once these are found.
double limit_of(const std::vector<Neighbour>& found, std::size_t k) {
  return found.size() == k ? found.back().squared_distance : infinity;
}

}  // namespace

SYMSURF_VECTORISED void PointTree::measure_boxes(const Boxes* boxes, const float* low,
                                                 const float* high, float slack, float* squared) {
  const Floats *box_low = reinterpret_cast<const Floats*>(&boxes->low),
               *box_high = reinterpret_cast<const Floats*>(&boxes->high);
  const Floats zero{};
  Floats sum = zero;
  for (int axis = 0; axis < 3; ++axis) {
    const Floats above = box_low[axis] - high[axis], below = low[axis] - box_high[axis];
    const Floats outside = (above > below ? above : below) - slack;
    const Floats gap = outside > zero ? outside : zero;
    sum += gap * gap;
  }
  *reinterpret_cast<Floats*>(squared) = sum;
}

std::array<Neighbour, PointTree::block> PointTree::nearest(const Queries& queries, double limit,
                                                           Index& near) const {
  constexpr double none = infinity;
  std::array<double, 6 * block> lanes;
  double* squared = &lanes[3 * block];
  std::array<float, 3> low, high;
  low.fill(std::numeric_limits<float>::infinity());
  high.fill(-std::numeric_limits<float>::infinity());
  for (int i = 0; i < block; ++i) {
    const Vector3 q = queries.col(i) - origin_;
    const bool asked = q.allFinite();
    for (int axis = 0; axis < 3; ++axis) {
      lanes[axis * block + i] = asked ? q[axis] : 0;
      if (!asked) continue;
      low[axis] = std::min(low[axis], in_boxes(q[axis]));
      high[axis] = std::max(high[axis], in_boxes(q[axis]));
    }
    squared[i] = asked ? std::min(limit, std::numeric_limits<double>::max()) : -1;
    lanes[4 * block + i] = none;
    lanes[5 * block + i] = -1;
  }
  const auto farthest = [&] { return *std::max_element(squared, squared + block); };
  const auto scan_leaf = [&](Index leaf) {
    scan(coordinates_.data(), order_.data(), leaf * fan, std::min((leaf + 1) * fan, size()),
         lanes.data());
  };
  scan_leaf(near / fan);
  double bound = farthest();
  if (bound >= 0)
    descend(low, high, bound, [&](Index leaf) {
      scan_leaf(leaf);
      bound = farthest();
    });

  std::array<Neighbour, block> found;
  for (int i = 0; i < block; ++i) {
    const double at = lanes[5 * block + i];
    if (at < 0) continue;
    near = static_cast<Index>(at);
    found[i] = {static_cast<Index>(lanes[4 * block + i]), squared[i]};
  }
  return found;
}

bool PointTree::nearest_within(const Block& queries, Index k, double reach,
                               std::array<std::vector<Neighbour>, block>& found) const {
  std::array<double, block * fan> squared;
  std::array<std::size_t, block> count{};
  descend(queries.low, queries.high, reach, [&](Index leaf) {
    const Index begin = leaf * fan, end = std::min(begin + fan, size());
    measure(coordinates_.data(), begin, end, queries.coordinates.data(), squared.data());
    for (int i = 0; i < block; ++i) {
      if (found[i].size() < count[i] + fan) found[i].resize(2 * (count[i] + fan));
      // Every point is written down and only those within reach stay: there is nothing to foretell.
      Neighbour* next = &found[i][count[i]];
      const Neighbour* const first = next;
      for (Index p = begin; p < end; ++p) {
        const double d = squared[(p - begin) * block + i];
        *next = {order_[p], d};
        next += d <= reach ? 1 : 0;
      }
      count[i] += static_cast<std::size_t>(next - first);
    }
  });
  const auto wanted = static_cast<std::size_t>(k);
  if (*std::min_element(count.begin(), count.end()) < wanted) return false;
  for (int i = 0; i < block; ++i) keep_nearest(found[i], count[i], wanted);
  return true;
}

void PointTree::nearest(const Queries& queries, Index k, Index near, double& reach,
                        std::array<std::vector<Neighbour>, block>& found) const {
  Block asked;
  for (int axis = 0; axis < 3; ++axis) {
    const auto begin = asked.coordinates.begin() + axis * block;
    for (int i = 0; i < block; ++i) begin[i] = queries(axis, i) - origin_[axis];
    const auto [least, most] = std::minmax_element(begin, begin + block);
    asked.low[axis] = in_boxes(*least);
    asked.high[axis] = in_boxes(*most);
  }
  if (reach == infinity || !nearest_within(asked, k, reach, found))
    nearest_near(asked, k, near, found);
  // Neighbours of neighbours lie about as far.
  constexpr double margin = 1.25;
  reach = 0;
  for (const auto& neighbours : found)
    reach = std::max(reach, margin * neighbours.back().squared_distance);
}

void PointTree::nearest_near(const Block& queries, Index k, Index near,
                             std::array<std::vector<Neighbour>, block>& found) const {
  std::array<double, block * fan> squared;
  std::array<double, block> limits;
  limits.fill(infinity);
  for (auto& neighbours : found) neighbours.clear();
  const auto wanted = static_cast<std::size_t>(k);
  const auto scan_leaf = [&](Index leaf) {
    const Index begin = leaf * fan, end = std::min(begin + fan, size());
    measure(coordinates_.data(), begin, end, queries.coordinates.data(), squared.data());
    const double* d = squared.data();
    for (Index p = begin; p < end; ++p)
      for (int i = 0; i < block; ++i, ++d)
        if (*d <= limits[i] && keep_best(found[i], wanted, Neighbour{order_[p], *d}))
          limits[i] = limit_of(found[i], wanted);
  };
  // The runs around the guess make a limit at once.
  const Index leaves = (size() + fan - 1) / fan, reach = (k + fan) / fan;
  const Index first = std::max<Index>(0, near / fan - reach / 2);
  const Index last = std::min(leaves, first + reach);
  for (Index leaf = first; leaf < last; ++leaf) scan_leaf(leaf);

  double bound = *std::max_element(limits.begin(), limits.end());
  descend(queries.low, queries.high, bound, [&](Index leaf) {
    if (leaf >= first && leaf < last) return;
    scan_leaf(leaf);
    bound = *std::max_element(limits.begin(), limits.end());
  });
}

PointTree::PointTree(PointsView points, const Context& context) {
  if (points.empty()) return;
  const auto matrix = points.matrix();
  const Vector3 low = matrix.colwise().minCoeff(), high = matrix.colwise().maxCoeff();
  origin_ = (low + high) / 2;
  const double extent = (high - low).maxCoeff();
  to_boxes_ = to_binary_unit(extent);
  reach_ = static_cast<float>(extent * to_boxes_);
  sort(points, context);
  context.report(0.5);

  coordinates_.resize(3 * order_.size());
  interruptible_for(context, size(), [&](Index p) {
    Eigen::Map<Vector3>(coordinates_.data() + 3 * p) = points[order_[p]] - origin_;
  });
  stack_boxes(context);
}

void PointTree::sort(PointsView points, const Context& context) {
  const double cells = static_cast<double>(1 << bits_per_axis) - 1;
  const double scale = reach_ > 0 ? cells / static_cast<double>(reach_) * to_boxes_ : 0;
  const Vector3 to_cells = Vector3::Constant(cells / 2);
  std::vector<std::uint64_t> keys(points.size());
  interruptible_for(context, points.size(), [&](Index i) {
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

void PointTree::stack_boxes(const Context& context) {
  constexpr float infinity = std::numeric_limits<float>::infinity();
  Boxes nothing;
  for (int axis = 0; axis < 3; ++axis) {
    nothing.low[axis].fill(infinity);
    nothing.high[axis].fill(-infinity);
  }
  const auto groups = [](Index items) { return (items + fan - 1) / fan; };

  Index boxes = groups(size());
  levels_.emplace_back(groups(boxes), nothing);
  interruptible_for(context, size(), [&](Index p) {
    const Index box = p / fan;
    Boxes& group = levels_[0][box / fan];
    for (int axis = 0; axis < 3; ++axis) {
      const float x = in_boxes(coordinates_[3 * p + axis]);
      float& low = group.low[axis][box % fan];
      float& high = group.high[axis][box % fan];
      low = std::min(low, x);
      high = std::max(high, x);
    }
  });
  while (levels_.back().size() > 1) {
    const std::vector<Boxes>& below = levels_.back();
    std::vector<Boxes> level(groups(static_cast<Index>(below.size())), nothing);
    for (std::size_t b = 0; b < below.size(); ++b)
      for (int axis = 0; axis < 3; ++axis) {
        const auto& low = below[b].low[axis];
        const auto& high = below[b].high[axis];
        level[b / fan].low[axis][b % fan] = *std::min_element(low.begin(), low.end());
        level[b / fan].high[axis][b % fan] = *std::max_element(high.begin(), high.end());
      }
    levels_.push_back(std::move(level));
  }
}

Neighbour PointTree::nearest(const Vector3& query, double limit) const {
  Neighbour best{-1, limit};
  search(query, limit, [&](Index position, double squared) {
    const Neighbour found{order_[position], squared};
    if (squared > limit || (best.index >= 0 && !(found < best))) return;
    best = found;
    limit = squared;
  });
  return best;
}

void PointTree::nearest(const Vector3& query, Index k, std::vector<Neighbour>& found) const {
  found.clear();
  const auto wanted = static_cast<std::size_t>(k);
  double limit = infinity;
  search(query, limit, [&](Index position, double squared) {
    if (keep_best(found, wanted, Neighbour{order_[position], squared}))
      limit = limit_of(found, wanted);
  });
}

}  // namespace symsurf
