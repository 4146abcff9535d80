#include <symsurf/context.h>
#include <symsurf/detect.h>

#include <chrono>

#include "detection/pipeline.h"
#include "processes/detect_shared.h"
#include "score/verdict.h"

namespace symsurf {

namespace {

Cloud cloud_of(PointsView points, PointsView normals, const Options& options,
               double tolerance = usual_tolerance) {
  Cloud cloud;
  cloud.points = points;
  cloud.normals = normals;
  cloud.seed = options.seed;
  cloud.tolerance = tolerance;
  return cloud;
}

}  // namespace

Result detect_in_one(PointsView points, const Options& options, const MethodImplementation& method,
                     const ParameterValues& values, const Context& context) {
  Cloud cloud = cloud_of(points, options.normals, options, values.real("tolerance"));
  cloud.faces = options.faces;
  Result result = run_pipeline(method, values, cloud, options.refuse_nonfinite, context);
  judge(result, result.mirror || result.pairs.rows() > 0, values.real("minimum_score"));
  return result;
}

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
  const MethodImplementation& method = implementation(options.method);
  double found = 0;
  MethodImplementation measuring;  // in place of the method
  measuring.name = method.name;
  measuring.minimum_points = method.minimum_points;
  measuring.preprocessing = Preprocessing::none();
  measuring.preprocessing.remove_outliers = method.preprocessing.remove_outliers;
  measuring.run = [&found](const Cloud& cloud, const ParameterValues&, const Context&) {
    found = cloud.diagonal;
    return Result{};
  };
  run_pipeline(measuring, {}, cloud_of(points, {}, options), options.refuse_nonfinite, context);
  return found;
}

}  // namespace symsurf
