#include <numeric>

#include "methods/registry.h"
#include "methods/thesis/separation.h"

namespace symsurf {

namespace {

// The thesis's Algorithm 1: mean squared distance of the partners from their
// lines (3.3).
double line_error(const Separation& separation, const Context&) {
  const std::vector<double>& squared = separation.squared;
  return std::accumulate(squared.begin(), squared.end(), 0.0) /
         static_cast<double>(separation.upper);
}

Result run_separation(const Cloud& cloud, const ParameterValues& values, const Context& context) {
  const PointTree tree(cloud.points, context.stage(0, 0.02));
  Result result =
      best_separation(cloud, tree, values.integer("steps"), line_error, context.stage(0.02, 1));
  result.method = "separation";
  return result;
}

}  // namespace

MethodImplementation separation_method() {
  MethodImplementation method;
  method.name = "separation";
  method.title = "Symmetry by separation (thesis, Algorithm 1)";
  method.summary =
      "Divides the cloud by planes through its centroid and maps "
      "one side onto the other along the "
      "normal; the score depends on the unit of the input.";
  method.parameters = {direction_steps()};
  method.preprocessing = Preprocessing::none();
  method.run = run_separation;
  return method;
}

}  // namespace symsurf
