#include <symsurf/errors.h>
#include <symsurf/match.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>

#include "cloud/cloud.h"
#include "preprocess/fills_bodies.h"
#include "preprocess/nonfinite_removal.h"
#include "preprocess/run_on.h"
#include "preprocess/skin.h"
#include "preprocess/strays.h"
#include "score/matching.h"
#include "score/mirror_score.h"
#include "score/verdict.h"

namespace symsurf {

namespace {

double share_explained(const Cloud& cloud, const PointTree& tree, const Mirror& mirror,
                       const Context& context) {
  const NearestPoints points(cloud.points, tree, context);
  return score_of(MirrorScore(cloud, points, context).fit(mirror), mirror.kind());
}

// Of a cloud that fills bodies that of their boundary.
double score_over(const Cloud& cloud, const PointTree& tree, const Mirror& mirror,
                  const Context& context) {
  const double whole = share_explained(cloud, tree, mirror, context);
  if (whole >= 1 || !fills_bodies(cloud, context)) return whole;
  const ParameterValues none;
  const Points rows = Skin(cloud, none, context).rows(cloud.points);
  const Cloud skin = checked_cloud(rows, {}, 1, context);
  return std::max(whole, share_explained(skin, PointTree(rows, context), mirror, context));
}

Result matched(PointsView points, const Mirror& mirror, double pair_distance,
               const Context& context) {
  const Context unreported = context.stage(0, 0);
  const Cloud cloud = checked_cloud(points, {}, 1, unreported);
  const auto run = [&](const Cloud& cloud) {
    Result result;
    PointTree tree(cloud.points, context.stage(0, 0.2));
    result.score = score_over(cloud, tree, mirror, unreported);
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
  judge(result, true, usual_minimum_score);
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return result;
}

}  // namespace symsurf
