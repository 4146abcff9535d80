#include <symsurf/errors.h>
#include <symsurf/match.h>

#include <chrono>
#include <cmath>
#include <optional>

#include "cloud.h"
#include "matching.h"
#include "nonfinite_removal.h"
#include "run_on.h"
#include "strays.h"

namespace symsurf {

namespace {

Result matched(PointsView points, const Mirror& mirror, double pair_distance,
               const Context& context) {
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
  return strays ? run_on(*strays, cloud, 1, context, run) : run(cloud);
}

}  // namespace

Result match(PointsView points, const Mirror& mirror, double pair_distance, const Context& context,
             bool refuse_nonfinite) {
  if (!(pair_distance >= 0 && std::isfinite(pair_distance)))
    throw InvalidParameter("pair_distance is " + to_string(Value(pair_distance)) +
                           "; allowed is [0, inf)");
  const auto start = std::chrono::steady_clock::now();
  std::optional<NonfiniteRemoval> nonfinite;
  if (!refuse_nonfinite) nonfinite = NonfiniteRemoval::where_any(points, 1, context.stage(0, 0));
  Points finite;
  if (nonfinite) finite = nonfinite->apply(points);
  Result result = matched(nonfinite ? finite : points, mirror, pair_distance, context);
  if (nonfinite) nonfinite->map_back(result);
  result.method = "match";
  result.parameters = {{"pair_distance", pair_distance}};
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return result;
}

}  // namespace symsurf
