#pragma once

#include <symsurf/context.h>
#include <symsurf/types.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

namespace symsurf {

/// Places in runs of 8, bounding boxes over the runs, boxes over runs of 8 boxes and so on, for
/// exact searches that bound their own measure of nearness box by box. Single precision: a search
/// allows for its rounding.
class BoxTree {
 public:
  static constexpr Index fan = 8;

  /// x, y and z of eight siblings side by side, so that one pass over an array measures them all.
  using Coordinates = std::array<std::array<float, fan>, 3>;
  using Bounds = std::array<float, fan>;
  struct Run {
    Coordinates place;
    std::array<std::int32_t, fan> index;
  };
  struct Boxes {
    Coordinates low, high;
    std::array<std::int32_t, fan> first;  ///< the lowest index inside
  };

  /// Adds places in an order that keeps neighbours together, each with its name.
  void add(float x, float y, float z, std::int32_t index);
  /// After the last, of at least one: builds the boxes. The last run repeats its last place.
  void build(const Context& context);
  /// Forgets the places and keeps the room.
  void clear();

  const std::vector<Run>& runs() const { return runs_; }

  /// Calls leaf(run) for the runs whose bound does not exceed `limit`, near ones first; leaf may
  /// lower the limit as it goes. bound(boxes, squared) writes the lower bounds of eight siblings.
  template <typename Bound, typename Leaf>
  void descend(const Bound& bound, const float& limit, const Leaf& leaf) const;

 private:
  Index size_ = 0;
  std::vector<Run> runs_;
  std::array<std::vector<Boxes>, 11> levels_;  // over the runs first; the last has one entry
  std::int32_t depth_ = 0;                     // levels in use
};

inline void BoxTree::add(float x, float y, float z, std::int32_t index) {
  const Index at = size_++ % fan;
  if (at == 0) runs_.emplace_back();
  Run& run = runs_.back();
  run.place[0][at] = x;
  run.place[1][at] = y;
  run.place[2][at] = z;
  run.index[at] = index;
}

template <typename Bound, typename Leaf>
void BoxTree::descend(const Bound& bound, const float& limit, const Leaf& leaf) const {
  struct Node {
    std::int32_t level, index;
    float squared;
  };
  std::array<Node, 8 * 16> stack;
  int top = 0;
  stack[top++] = {depth_ - 1, 0, 0.0f};
  while (top > 0) {
    const Node node = stack[--top];
    if (node.squared > limit) continue;
    if (node.level < 0) {
      leaf(runs_[node.index]);
      continue;
    }
    Bounds squared;
    bound(levels_[node.level][node.index], squared);
    const auto children =
        static_cast<std::int32_t>(node.level > 0 ? levels_[node.level - 1].size() : runs_.size());
    const std::int32_t begin = node.index * static_cast<std::int32_t>(fan);
    const std::int32_t end = std::min<std::int32_t>(begin + fan, children);
    const int first = top;
    for (std::int32_t child = begin; child < end; ++child) {
      const float near = squared[child - begin];
      if (near > limit) continue;
      int at = top++;
      for (; at > first && stack[at - 1].squared < near; --at) stack[at] = stack[at - 1];
      stack[at] = {node.level - 1, child, near};
    }
  }
}

}  // namespace symsurf
