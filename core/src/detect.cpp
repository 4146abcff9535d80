#include <symsurf/detect.h>

#include <chrono>

#include "cloud.h"
#include "outline.h"
#include "shared_run.h"

namespace symsurf {

namespace {

Result detect_alone(PointsView points, const Options& options, const Method& method,
                    const ParameterValues& values, const Context& context) {
  Cloud cloud = checked_cloud(points, options.normals, method.minimum_points, context.stage(0, 0));
  cloud.seed = options.seed;
  context.report(0);
  Result result = method.run(cloud, values, context);
  set_footprint(result, outline(points, context));
  return result;
}

}  // namespace

Result detect(PointsView points, const Options& options, const Context& context) {
  const auto start = std::chrono::steady_clock::now();
  const Method& chosen = method(options.method);
  const ParameterValues values(chosen.name, chosen.parameters, options.parameters);
  const auto run = context.communicator() ? detect_shared : detect_alone;
  Result result = run(points, options, chosen, values, context);
  if (result.parameters.empty()) result.parameters = values.all();
  context.report(1);
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return result;
}

}  // namespace symsurf
