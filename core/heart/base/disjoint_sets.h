#pragma once

#include <symsurf/points.h>

#include <numeric>
#include <vector>

namespace symsurf {

/// The same names in the same places, numbered in the order in which they first occur. Names are
/// below the size.
inline std::vector<Index> renumbered(std::vector<Index> names) {
  std::vector<Index> number(names.size(), -1);
  Index count = 0;
  for (Index& name : names) {
    if (number[name] < 0) number[name] = count++;
    name = number[name];
  }
  return names;
}

/// Numbers from 0 on in disjoint sets, each known by its root (Galler and Fischer 1964).
class DisjointSets {
 public:
  /// Each number alone.
  explicit DisjointSets(Index size) : parent_(size) {
    std::iota(parent_.begin(), parent_.end(), Index{0});
  }

  Index size() const { return static_cast<Index>(parent_.size()); }

  Index root(Index i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }

  /// The set of the second becomes a part of that of the first, whose root stays.
  void join(Index one, Index other) { parent_[root(other)] = root(one); }

  /// Of each number that of its set, in the order of their first ones.
  std::vector<Index> numbered() {
    for (Index i = 0; i < size(); ++i) parent_[i] = root(i);
    return renumbered(parent_);
  }

 private:
  std::vector<Index> parent_;
};

}  // namespace symsurf
