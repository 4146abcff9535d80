#include <symsurf/detect.h>

#include <chrono>

#include "detection/run_alone.h"
#include "detection/shared_run.h"
#include "score/verdict.h"

namespace symsurf {

Result detect(PointsView points, const Options& options, const Context& context) {
  const auto start = std::chrono::steady_clock::now();
  const Method& chosen = method(options.method);
  const ParameterValues values(chosen.name, chosen.parameters, options.parameters);
  Result result = context.communicator() ? detect_shared(points, options, chosen, values, context)
                                         : run_alone(points, options, chosen, values, context);
  if (result.parameters.empty()) result.parameters = values.all();
  judge(result, result.mirror || result.pairs.rows() > 0, values.real("minimum_score"));
  context.report(1);
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return result;
}

}  // namespace symsurf
