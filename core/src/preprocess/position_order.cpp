#include "preprocess/position_order.h"

#include <algorithm>
#include <iterator>
#include <numeric>

#include "base/parallel.h"
#include "base/radix_sort.h"
#include "score/matching.h"
#include "spatial/triple_index.h"

namespace symsurf {

bool PositionOrder::apply(Cloud& cloud, const Context& context) {
  const PointsView points = cloud.points;
  order_.resize(points.size());
  std::iota(order_.begin(), order_.end(), 0);
  std::vector<std::uint64_t> keys(points.size());
  for (const int axis : {2, 1, 0}) {
    interruptible_for(context, points.size(), [&](Index row) {
      keys[row] = static_cast<std::uint64_t>(ordered_bits(points[order_[row]])[axis]) ^
                  std::uint64_t{1} << 63;
    });
    radix_sort(keys, order_, context);
  }
  if (std::is_sorted(order_.begin(), order_.end())) return false;
  keep(cloud, order_);
  return true;
}

void PositionOrder::map_back(Result& result, PairDistance, const Context&) const {
  std::vector<Index> row_of(order_.size(), -1), rows;
  for (Index row = 0; row < result.pairs.rows(); ++row) {
    for (Index& point : result.pairs.row(row)) point = order_[point];
    row_of[result.pairs(row, 0)] = row;
  }
  std::copy_if(row_of.begin(), row_of.end(), std::back_inserter(rows),
               [](Index row) { return row >= 0; });
  keep_pairs(result, rows);
}

}  // namespace symsurf
