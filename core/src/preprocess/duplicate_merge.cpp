#include "preprocess/duplicate_merge.h"

#include <symsurf/context.h>

#include <string>
#include <vector>

#include "score/matching.h"

namespace symsurf {

bool DuplicateMerge::apply(Cloud& cloud, const Context& context) {
  if (!has_many_duplicates(cloud.points, context)) return false;
  distinct_ = distinct_points(cloud.points, context);
  if (static_cast<Index>(distinct_.first.size()) < minimum_points_)
    throw InvalidInput(std::to_string(cloud.points.size()) + " points given, " +
                       std::to_string(distinct_.first.size()) + " of them distinct; at least " +
                       std::to_string(minimum_points_) + " distinct points are needed");
  keep(cloud, distinct_.first);
  return true;
}

void DuplicateMerge::map_back(Result& result, PairDistance, const Context&) const {
  std::vector<Index> row_of(distinct_.first.size(), -1);
  for (Index row = 0; row < result.pairs.rows(); ++row) row_of[result.pairs(row, 0)] = row;
  std::vector<Index> paired, rows;
  for (std::size_t i = 0; i < distinct_.number.size(); ++i) {
    const Index row = row_of[distinct_.number[i]];
    if (row < 0) continue;
    paired.push_back(static_cast<Index>(i));
    rows.push_back(row);
  }
  keep_pairs(result, rows);
  for (Index row = 0; row < result.pairs.rows(); ++row)
    result.pairs.row(row) << paired[row], distinct_.first[result.pairs(row, 1)];
}

}  // namespace symsurf
