#include "run_alone.h"

#include <optional>

#include "cloud.h"
#include "outline.h"
#include "places.h"
#include "run_on.h"
#include "skin.h"
#include "strays.h"

namespace symsurf {

Result run_alone(PointsView points, PointsView normals, std::uint64_t seed, const Method& method,
                 const ParameterValues& values, const Context& context) {
  const Context unreported = context.stage(0, 0);
  const Index least = method.minimum_points;
  Cloud cloud = checked_cloud(points, normals, least, unreported);
  cloud.seed = seed;
  context.report(0);

  const auto run = [&](const Cloud& cloud) { return method.run(cloud, values, context); };
  const auto run_on_skin = [&](const Cloud& cloud) {
    const auto skin = Skin::where_filled(cloud, method, values, unreported);
    return skin ? run_on(*skin, cloud, least, context, run) : run(cloud);
  };
  const auto run_on_places = [&](const Cloud& cloud) {
    std::optional<Places> places;
    if (!method.sees_copies) places = Places::where_copied(cloud.points, unreported);
    Result result = places && places->size() >= least
                        ? run_on(*places, cloud, least, context, run_on_skin)
                        : run_on_skin(cloud);
    set_footprint(result, outline(cloud.points, context));
    return result;
  };
  const auto strays = Strays::where_any(cloud, method, unreported);
  return strays ? run_on(*strays, cloud, least, context, run_on_places) : run_on_places(cloud);
}

}  // namespace symsurf
