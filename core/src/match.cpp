#include <symsurf/errors.h>
#include <symsurf/match.h>

#include <chrono>

#include "cloud.h"
#include "matching.h"

namespace symsurf {

Result match(PointsView points, const Mirror& mirror, double pair_distance,
             const Context& context) {
  if (!(pair_distance >= 0))
    throw InvalidParameter("pair_distance is " + to_string(Value(pair_distance)) +
                           "; allowed is [0, inf)");
  const auto start = std::chrono::steady_clock::now();
  const Cloud cloud = checked_cloud(points, {}, 1, context.stage(0, 0));
  Result result;
  result.method = "match";
  result.parameters = {{"pair_distance", pair_distance}};
  PointTree tree(points, context.stage(0, 0.2));
  add_pairs(result, points, std::move(tree), mirror, pair_distance * cloud.diagonal,
            context.stage(0.2, 1));
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return result;
}

}  // namespace symsurf
