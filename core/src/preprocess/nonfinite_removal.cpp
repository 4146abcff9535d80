#include "preprocess/nonfinite_removal.h"

#include <symsurf/errors.h>

#include <string>
#include <utility>
#include <vector>

#include "base/gathered.h"
#include "cloud/cloud.h"

namespace symsurf {

std::optional<NonfiniteRemoval> NonfiniteRemoval::where_any(PointsView own, Index needed,
                                                            const Context& context) {
  std::vector<Index> removed;
  if (is_numerable(own.size()) && !are_finite(own))
    for (Index i = 0; i < own.size(); ++i)
      if (!own[i].allFinite()) removed.push_back(i);
  const Share share = share_of(context, own.size());
  RowRemoval removal(std::move(removed), share.first, context);
  if (removal.count() == 0) return std::nullopt;
  const Index left = share.total - removal.count();
  if (left < needed)
    throw InvalidInput(std::to_string(left) + " of " + std::to_string(share.total) +
                       " points given are finite; at least " + std::to_string(needed) +
                       (needed == 1 ? " is needed" : " are needed"));
  return NonfiniteRemoval(std::move(removal));
}

void NonfiniteRemoval::map_back(Result& result) const {
  removal_.map_back(result);
  result.statistics["nonfinite_points"] = removal_.count();
}

}  // namespace symsurf
