#include "run_alone.h"

#include <optional>

#include "cloud.h"
#include "outline.h"
#include "places.h"

namespace symsurf {

namespace {

Result run_on_places(const Cloud& cloud, const Method& method, const ParameterValues& values,
                     const Context& context) {
  std::optional<Places> places;
  if (!method.sees_copies) places = Places::where_copied(cloud.points, context.stage(0, 0));
  if (!places || places->size() < method.minimum_points) return method.run(cloud, values, context);
  const Points points = places->rows(cloud.points);
  const Points normals = cloud.normals.empty() ? Points(0, 3) : places->rows(cloud.normals);
  Cloud apart = checked_cloud(points, normals, method.minimum_points, context.stage(0, 0));
  apart.seed = cloud.seed;
  Result result = method.run(apart, values, context);
  places->hand_on(result);
  return result;
}

}  // namespace

Result run_alone(PointsView points, PointsView normals, std::uint64_t seed, const Method& method,
                 const ParameterValues& values, const Context& context) {
  Cloud cloud = checked_cloud(points, normals, method.minimum_points, context.stage(0, 0));
  cloud.seed = seed;
  context.report(0);
  Result result = run_on_places(cloud, method, values, context);
  set_footprint(result, outline(points, context));
  return result;
}

}  // namespace symsurf
