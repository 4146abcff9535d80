#include "methods/registry.h"
#include "methods/thesis/trials.h"

namespace symsurf {

namespace {

// Mean squared distance of the partners from their lines (3.3).
double projection_error(const Separation& separation) {
  double sum = 0;
  for (const double squared : separation.squared()) sum += squared;
  return sum / static_cast<double>(separation.squared().size());
}

Result run_separation(const Cloud& cloud, const ParameterValues& values, const Context& context) {
  const PointTree tree(cloud.points, context.stage(0, 0.02));
  Result result = best_separation(cloud, tree, values.integer("steps"), projection_error,
                                  context.stage(0.02, 1));
  result.method = "separation";
  return result;
}

}  // namespace

MethodImplementation separation_method() {
  MethodImplementation method;
  method.name = "separation";
  method.title = "Symmetry by separation (thesis, Algorithm 1)";
  method.summary =
      "Divides the cloud by planes through its centroid and maps one side onto the other along the "
      "normal; the score depends on the unit of the input.";
  method.parameters = {direction_steps()};
  method.preprocessing = Preprocessing::none();
  method.run = run_separation;
  return method;
}

}  // namespace symsurf
