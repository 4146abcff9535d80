#include "preprocess/duplicate_merge.h"

#include <symsurf/errors.h>

#include <algorithm>
#include <string>

#include "base/parallel.h"
#include "score/matching.h"
#include "spatial/triple_index.h"

namespace symsurf {

namespace {

// Of points sampled by their hashes: equal ones are chosen or left out together.
bool has_many_duplicates(PointsView points, const Context& context) {
  constexpr double wanted = 1000, notable = 0.05;
  const double share = std::min(1.0, wanted / static_cast<double>(points.size()));
  std::vector<std::uint64_t> chosen;
  interruptible_for(context, points.size(), [&](Index i) {
    const std::uint64_t hash = hash_of(points[i]);
    if (is_chosen(hash, share)) chosen.push_back(hash);
  });
  std::sort(chosen.begin(), chosen.end());
  const auto distinct = std::unique(chosen.begin(), chosen.end()) - chosen.begin();
  const auto all = static_cast<double>(chosen.size());
  return static_cast<double>(distinct) < (1 - notable) * all;
}

}  // namespace

bool DuplicateMerge::apply(Cloud& cloud, const Context& context) {
  if (!has_many_duplicates(cloud.points, context)) return false;
  find_distinct(cloud.points, context);
  if (static_cast<Index>(first_.size()) < minimum_points_)
    throw InvalidInput(std::to_string(cloud.points.size()) + " points given, " +
                       std::to_string(first_.size()) + " of them distinct; at least " +
                       std::to_string(minimum_points_) + " distinct points are needed");
  keep(cloud, first_);
  return true;
}

void DuplicateMerge::find_distinct(PointsView points, const Context& context) {
  distinct_.resize(points.size());
  TripleIndex positions;
  interruptible_for(context, points.size(), [&](Index i) {
    const Index position = positions.add(ordered_bits(points[i]));
    if (position == static_cast<Index>(first_.size()))
      first_.push_back(static_cast<std::int32_t>(i));
    distinct_[i] = static_cast<std::int32_t>(position);
  });
}

void DuplicateMerge::map_back(Result& result, double, const Context&) const {
  std::vector<Index> row_of(first_.size(), -1);
  for (Index row = 0; row < result.pairs.rows(); ++row) row_of[result.pairs(row, 0)] = row;
  std::vector<Index> paired, rows;
  for (std::size_t i = 0; i < distinct_.size(); ++i) {
    const Index row = row_of[distinct_[i]];
    if (row < 0) continue;
    paired.push_back(static_cast<Index>(i));
    rows.push_back(row);
  }
  keep_pairs(result, rows);
  for (Index row = 0; row < result.pairs.rows(); ++row)
    result.pairs.row(row) << paired[row], first_[result.pairs(row, 1)];
}

}  // namespace symsurf
