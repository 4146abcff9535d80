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

// Half against half, which takes no more than three steps.
template <typename T>
T least(std::array<T, BoxTree::fan> x) {
  for (int half = BoxTree::fan / 2; half > 0; half /= 2)
    for (int i = 0; i < half; ++i) x[i] = std::min(x[i], x[i + half]);
  return x[0];
}
template <typename T>
T most(std::array<T, BoxTree::fan> x) {
  for (int half = BoxTree::fan / 2; half > 0; half /= 2)
    for (int i = 0; i < half; ++i) x[i] = std::max(x[i], x[i + half]);
  return x[0];
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

void BoxTree::clear() {
  size_ = 0;
  runs_.clear();
}

void BoxTree::build(const Context& context) {
  for (Run& last = runs_.back(); size_ % fan != 0; ++size_) {
    const Index at = size_ % fan;
    for (auto& x : last.place) x[at] = x[at - 1];
    last.index[at] = last.index[at - 1];
  }

  // Boxes beyond the last are empty: no limit reaches them.
  Boxes nothing;
  for (int axis = 0; axis < 3; ++axis) {
    nothing.low[axis].fill(std::numeric_limits<float>::infinity());
    nothing.high[axis].fill(-std::numeric_limits<float>::infinity());
  }
  nothing.first.fill(std::numeric_limits<std::int32_t>::max());
  depth_ = 0;
  const auto stack = [&](const auto& below, const auto& low, const auto& high, const auto& first) {
    std::vector<Boxes>& boxes = levels_[depth_++];
    boxes.resize((below.size() + fan - 1) / fan);
    boxes.back() = nothing;
    interruptible_for(context, static_cast<Index>(below.size()), [&](Index b) {
      Boxes& group = boxes[b / fan];
      const Index box = b % fan;
      for (int axis = 0; axis < 3; ++axis) {
        group.low[axis][box] = least(low(below[b])[axis]);
        group.high[axis][box] = most(high(below[b])[axis]);
      }
      group.first[box] = least(first(below[b]));
    });
  };
  const auto place = [](const Run& run) -> const Coordinates& { return run.place; };
  const auto index = [](const Run& run) -> const auto& { return run.index; };
  stack(runs_, place, place, index);
  const auto low = [](const Boxes& boxes) -> const Coordinates& { return boxes.low; };
  const auto high = [](const Boxes& boxes) -> const Coordinates& { return boxes.high; };
  const auto first = [](const Boxes& boxes) -> const auto& { return boxes.first; };
  while (levels_[depth_ - 1].size() > 1) stack(levels_[depth_ - 1], low, high, first);
}

}  // namespace symsurf
