#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <limits>

#include "methods/thesis/box_tree.h"

namespace symsurf {

/// Eight queries close together, answered in one descent: what they have in common, whatever
/// distance they measure.
class BlockQueries {
 public:
  static constexpr Index block = BoxTree::fan;
  using Limits = std::array<float, block>;
  using Bits = std::array<std::int32_t, block>;  ///< of each query, a bit for each of a run

  /// Begins a block: how far each looks, squared.
  void begin(const Limits& squared) { limits_ = squared; }

  static Limits anywhere() {
    Limits limits;
    limits.fill(std::numeric_limits<float>::infinity());
    return limits;
  }

 protected:
  float farthest() const { return *std::max_element(limits_.begin(), limits_.end()); }

  Limits limits_{};

  template <typename Queries, typename Visit, typename Last>
  friend void visit_nearest(const BoxTree& tree, Queries& queries, const Visit& visit,
                            const Last& last);
};

/// No index too high to be wanted.
inline std::int32_t any_index() { return std::numeric_limits<std::int32_t>::max(); }

/// visit(which, index) for the indices that are nearest to each query, give or take the rounding:
/// in single precision run by run, then one by one what is left of some runs. last() tells what
/// index is the highest that is still wanted, which spares most of what is equally near. Of
/// `Queries`, beside the common part: bound(boxes, squared) as BoxTree::descend has it, infinite
/// where no query reaches; lower_limits(run) makes each look no farther than to the nearest of the
/// run, false where all are too far; near(run) tells what lies within the limits.
template <typename Queries, typename Visit, typename Last>
void visit_nearest(const BoxTree& tree, Queries& queries, const Visit& visit, const Last& last) {
  std::array<const BoxTree::Run*, 16> runs;
  std::size_t waiting = 0;
  std::int32_t highest = last();
  const auto visit_waiting = [&] {
    for (std::size_t r = 0; r < waiting; ++r) {
      const BlockQueries::Bits bits = queries.near(*runs[r]);
      for (int which = 0; which < BlockQueries::block; ++which)
        for (auto rest = static_cast<std::uint32_t>(bits[which]); rest != 0; rest &= rest - 1)
          visit(which, runs[r]->index[std::countr_zero(rest)]);
    }
    waiting = 0;
    highest = last();
  };
  float limit = queries.farthest();
  tree.descend(
      [&](const BoxTree::Boxes& boxes, BoxTree::Bounds& squared) {
        queries.bound(boxes, squared);
        for (Index i = 0; i < BoxTree::fan; ++i)
          if (boxes.first[i] > highest) squared[i] = std::numeric_limits<float>::infinity();
      },
      limit,
      [&](const BoxTree::Run& run) {
        if (!queries.lower_limits(run)) return;
        limit = queries.farthest();
        runs[waiting++] = &run;
        if (waiting == runs.size()) visit_waiting();
      });
  visit_waiting();
}

}  // namespace symsurf
