#include "box_tree.h"

#include <cmath>
#include <limits>
#include <numeric>

#include "parallel.h"
#include "radix_sort.h"

namespace symsurf {

namespace {

constexpr int bits_per_axis = 14;

// Spreads the low 14 bits to every third.
std::uint64_t spread(std::uint64_t v) {
  v = (v | v << 16) & 0x0000ff0000ff;
  v = (v | v << 8) & 0x00f00f00f00f;
  v = (v | v << 4) & 0x0c30c30c30c3;
  return (v | v << 2) & 0x249249249249;
}

}  // namespace

std::vector<std::int32_t> z_order(const std::vector<Vector3>& places, const Context& context) {
  Vector3 low = places.front(), high = low;
  for (const Vector3& x : places) {
    low = low.cwiseMin(x);
    high = high.cwiseMax(x);
  }
  const double extent = (high - low).maxCoeff(), cells = (1 << bits_per_axis) - 1;
  const double scale = extent > 0 ? cells / extent : 0;
  std::vector<std::uint64_t> keys(places.size());
  interruptible_for(context, static_cast<Index>(places.size()), [&](Index i) {
    for (int axis = 0; axis < 3; ++axis) {
      const double at = std::min((places[i][axis] - low[axis]) * scale, cells);
      keys[i] |= spread(static_cast<std::uint64_t>(at)) << (2 - axis);
    }
  });
  std::vector<std::int32_t> order(places.size());
  std::iota(order.begin(), order.end(), 0);
  radix_sort(keys, order, context);
  return order;
}

BoxTree::BoxTree(const std::vector<Vector3>& places, const std::vector<std::int32_t>& indices,
                 const Context& context)
    : size_(static_cast<Index>(places.size())) {
  Boxes nothing;
  for (int axis = 0; axis < 3; ++axis) {
    nothing.low[axis].fill(std::numeric_limits<float>::max());
    nothing.high[axis].fill(std::numeric_limits<float>::lowest());
  }
  nothing.first.fill(std::numeric_limits<std::int32_t>::max());

  float reach = 0;
  levels_.emplace_back(groups(groups(size_)), nothing);
  interruptible_for(context, size_, [&](Index p) {
    Boxes& group = levels_[0][p / fan / fan];
    const Index box = p / fan % fan;
    group.first[box] = std::min(group.first[box], indices[p]);
    for (int axis = 0; axis < 3; ++axis) {
      const float x = static_cast<float>(places[p][axis]);
      group.low[axis][box] = std::min(group.low[axis][box], x);
      group.high[axis][box] = std::max(group.high[axis][box], x);
      reach = std::max(reach, std::abs(x));
    }
  });
  slack_ = 1e-6f * reach;
  while (levels_.back().size() > 1) {
    const std::vector<Boxes>& below = levels_.back();
    std::vector<Boxes> level(groups(static_cast<Index>(below.size())), nothing);
    for (std::size_t b = 0; b < below.size(); ++b) {
      Boxes& group = level[b / fan];
      const std::size_t box = b % fan;
      group.first[box] = *std::min_element(below[b].first.begin(), below[b].first.end());
      for (int axis = 0; axis < 3; ++axis) {
        const auto &low = below[b].low[axis], &high = below[b].high[axis];
        group.low[axis][box] = *std::min_element(low.begin(), low.end());
        group.high[axis][box] = *std::max_element(high.begin(), high.end());
      }
    }
    levels_.push_back(std::move(level));
  }
}

}  // namespace symsurf
