#include <symsurf/errors.h>
#include <symsurf/match.h>

#include <chrono>
#include <cmath>

#include "cloud.h"
#include "matching.h"
#include "run_on.h"
#include "strays.h"

namespace symsurf {

Result match(PointsView points, const Mirror& mirror, double pair_distance,
             const Context& context) {
  if (!(pair_distance >= 0 && std::isfinite(pair_distance)))
    throw InvalidParameter("pair_distance is " + to_string(Value(pair_distance)) +
                           "; allowed is [0, inf)");
  const auto start = std::chrono::steady_clock::now();
  const Context unreported = context.stage(0, 0);
  const Cloud cloud = checked_cloud(points, {}, 1, unreported);
  const auto run = [&](const Cloud& cloud) {
    Result result;
    PointTree tree(cloud.points, context.stage(0, 0.2));
    add_pairs(result, cloud.points, std::move(tree), mirror, pair_distance * cloud.diagonal,
              context.stage(0.2, 1));
    return result;
  };
  const auto strays = Strays::where_any(cloud, 1, unreported);
  Result result = strays ? run_on(*strays, cloud, 1, context, run) : run(cloud);
  result.method = "match";
  result.parameters = {{"pair_distance", pair_distance}};
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return result;
}

}  // namespace symsurf
