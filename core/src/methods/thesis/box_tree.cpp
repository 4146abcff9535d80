#include "methods/thesis/box_tree.h"

#include <limits>

#include "base/parallel.h"

namespace symsurf {

namespace {

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
