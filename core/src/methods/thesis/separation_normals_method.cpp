#include "methods/registry.h"
#include "methods/thesis/estimated_normals.h"
#include "methods/thesis/parallel_normals.h"
#include "methods/thesis/trials.h"

namespace symsurf {

namespace {

Result run_separation_normals(const Cloud& cloud, const ParameterValues& values,
                              const Context& context) {
  const PointTree tree(cloud.points, context.stage(0, 0.02));
  const Points normals = given_or_estimated_normals(cloud, tree, values, context.stage(0.02, 0.1));
  const ParallelNormals parallel(cloud.points, normals, !signed_normals(cloud, values),
                                 context.stage(0.1, 0.15));
  Result result = best_separation(
      cloud, tree, values.integer("steps"),
      [&](const Separation& separation) { return parallel.projection_error(separation); },
      context.stage(0.15, 1));
  result.method = "separation_normals";
  return result;
}

}  // namespace

MethodImplementation separation_normals_method() {
  MethodImplementation method;
  method.name = "separation_normals";
  method.title = "Symmetry by separation and normals (thesis, Algorithm 2)";
  method.summary =
      "As separation, but scores a plane by how near the partner is to the point with the most "
      "similar normal; the score depends on the unit of the input.";
  method.parameters = normal_parameters();
  method.parameters.insert(method.parameters.begin(), direction_steps());
  method.preprocessing = Preprocessing::none();
  method.run = run_separation_normals;
  return method;
}

}  // namespace symsurf
