#include "run_alone.h"

#include <optional>

#include "cloud.h"
#include "outline.h"
#include "places.h"
#include "strays.h"

namespace symsurf {

namespace {

// Runs on the rows that `part` chooses, and has it hand on to all what is found of them.
template <typename Part, typename Run>
Result run_on(const Part& part, const Cloud& cloud, Index minimum_points, const Context& context,
              const Run& run) {
  const Points points = part.rows(cloud.points);
  const Points normals = cloud.normals.empty() ? Points(0, 3) : part.rows(cloud.normals);
  Cloud apart = checked_cloud(points, normals, minimum_points, context.stage(0, 0));
  apart.seed = cloud.seed;
  Result result = run(apart);
  part.hand_on(result);
  return result;
}

}  // namespace

Result run_alone(PointsView points, PointsView normals, std::uint64_t seed, const Method& method,
                 const ParameterValues& values, const Context& context) {
  const Context unreported = context.stage(0, 0);
  const Index least = method.minimum_points;
  Cloud cloud = checked_cloud(points, normals, least, unreported);
  cloud.seed = seed;
  context.report(0);

  const auto run = [&](const Cloud& cloud) { return method.run(cloud, values, context); };
  const auto run_on_places = [&](const Cloud& cloud) {
    std::optional<Places> places;
    if (!method.sees_copies) places = Places::where_copied(cloud.points, unreported);
    Result result = places && places->size() >= least ? run_on(*places, cloud, least, context, run)
                                                      : run(cloud);
    set_footprint(result, outline(cloud.points, context));
    return result;
  };
  std::optional<Strays> strays;
  if (!method.sees_strays) strays = Strays::where_any(cloud, least, unreported);
  return strays ? run_on(*strays, cloud, least, context, run_on_places) : run_on_places(cloud);
}

}  // namespace symsurf
