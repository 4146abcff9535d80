#include <symsurf/context.h>
#include <symsurf/detect.h>

#include <chrono>

#include "detection/pipeline.h"
#include "processes/processes.h"
#include "registry.h"

namespace symsurf {

Result detect(PointsView points, const Options& options, const Context& context) {
  const auto start = std::chrono::steady_clock::now();
  const MethodImplementation& method = implementation(options.method);
  const ParameterValues values(method.name, method.parameters, options.parameters);
  const auto run = context.communicator() ? detect_shared : detect_in_one;
  Result result = run(points, options, method, values, context);
  if (result.parameters.empty()) result.parameters = values.all();
  context.report(1);
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return result;
}

double diagonal(PointsView points, const Options& options, const Context& context) {
  return diagonal_of(points, options, implementation(options.method), context);
}

}  // namespace symsurf
