#pragma once

#include <symsurf/context.h>
#include <symsurf/types.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

namespace symsurf {

/// The order of the places along the Z-order curve, equal places by index.
std::vector<std::int32_t> z_order(const std::vector<Vector3>& places, const Context& context);

/// Bounding boxes over runs of 8 consecutive places, boxes over runs of 8 boxes and so on, for
/// exact searches that bound their own measure of nearness box by box.
class BoxTree {
 public:
  static constexpr Index fan = 8;

  /// Eight siblings side by side, so that one pass over an array bounds them all.
  struct Boxes {
    std::array<std::array<float, fan>, 3> low, high;
    std::array<std::int32_t, fan> first;  ///< the lowest index inside
  };
  using Bounds = std::array<float, fan>;

  /// The places in an order that keeps neighbours together; `indices` are their names.
  BoxTree(const std::vector<Vector3>& places, const std::vector<std::int32_t>& indices,
          const Context& context);

  /// More than the rounding of any coordinate of a box.
  float slack() const { return slack_; }

  /// Calls leaf(begin, end) for the runs whose bound does not exceed `limit`, near ones first; leaf
  /// may lower the limit as it goes. bound(boxes, squared) writes the lower bounds of eight
  /// siblings.
  template <typename Bound, typename Leaf>
  void descend(const Bound& bound, const double& limit, const Leaf& leaf) const;

 private:
  static Index groups(Index items) { return (items + fan - 1) / fan; }

  Index size_;
  float slack_ = 0;
  std::vector<std::vector<Boxes>> levels_;  // leaves first; the last has one entry
};

template <typename Bound, typename Leaf>
void BoxTree::descend(const Bound& bound, const double& limit, const Leaf& leaf) const {
  struct Node {
    std::int32_t level, index;
    float squared;
  };
  std::array<Node, 8 * 16> stack;
  int top = 0;
  stack[top++] = {static_cast<std::int32_t>(levels_.size()) - 1, 0, 0.0f};
  while (top > 0) {
    const Node node = stack[--top];
    if (node.squared > limit) continue;
    if (node.level < 0) {
      leaf(node.index * fan, std::min((node.index + 1) * fan, size_));
      continue;
    }
    Bounds squared;
    bound(levels_[node.level][node.index], squared);
    const Index children =
        node.level > 0 ? static_cast<Index>(levels_[node.level - 1].size()) : groups(size_);
    const Index begin = node.index * fan, end = std::min(begin + fan, children);
    const int first = top;
    for (Index child = begin; child < end; ++child) {
      const float near = squared[child - begin];
      if (near > limit) continue;
      int at = top++;
      for (; at > first && stack[at - 1].squared < near; --at) stack[at] = stack[at - 1];
      stack[at] = {node.level - 1, static_cast<std::int32_t>(child), near};
    }
  }
}

}  // namespace symsurf
