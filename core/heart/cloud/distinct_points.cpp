#include "cloud/distinct_points.h"

#include <iterator>
#include <map>

#include "base/parallel.h"
#include "cloud/voxel_grid.h"

namespace symsurf {

DistinctPoints distinct_points(PointsView points, const Context& context) {
  DistinctPoints distinct;
  distinct.number.resize(points.size());
  TripleIndex positions;
  interruptible_for(context, points.size(), [&](Index i) {
    const Index position = positions.add(ordered_bits(points[i]));
    if (position == static_cast<Index>(distinct.first.size()))
      distinct.first.push_back(static_cast<std::int32_t>(i));
    distinct.number[i] = static_cast<std::int32_t>(position);
  });
  return distinct;
}

// By the points with the least hashes, each with all of its copies (Bar-Yossef et al., "Counting
// distinct elements in a data stream", 2002).
bool has_many_duplicates(PointsView points, const Context& context) {
  constexpr std::size_t most = 1000;  // distinct points looked at
  constexpr double notable = 0.05;
  std::map<std::uint64_t, Index> copies;  // by hash
  std::uint64_t greatest = ~std::uint64_t{0};
  interruptible_for(context, points.size(), [&](Index i) {
    const std::uint64_t hash = hash_of(points[i]);
    if (hash > greatest) return;
    ++copies[hash];
    if (copies.size() <= most) return;
    copies.erase(std::prev(copies.end()));
    greatest = copies.rbegin()->first;
  });
  Index all = 0;
  for (const auto& [hash, count] : copies) all += count;
  return static_cast<double>(copies.size()) < (1 - notable) * static_cast<double>(all);
}

}  // namespace symsurf
