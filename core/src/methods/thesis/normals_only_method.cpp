#include "methods/registry.h"
#include "methods/thesis/along_normals.h"
#include "methods/thesis/estimated_normals.h"
#include "methods/thesis/sheet_score.h"

namespace symsurf {

namespace {

Result run_normals_only(const Cloud& cloud, const ParameterValues& values, const Context& context) {
  const PointTree tree(cloud.points, context.stage(0, 0.05));
  const Points normals = given_or_estimated_normals(cloud, tree, values, context.stage(0.05, 0.4));
  Result result = pairs_along_normals(cloud.points, tree, normals, context.stage(0.4, 0.9));
  result.method = "normals_only";
  result.score = sheet_score(cloud.points, tree, result, context.stage(0.9, 1));
  result.statistics["projection_error"] =
      result.residuals.squaredNorm() / static_cast<double>(result.residuals.size());
  return result;
}

}  // namespace

MethodImplementation normals_only_method() {
  MethodImplementation method;
  method.name = "normals_only";
  method.title = "Symmetry by normals (thesis, Algorithm 3)";
  method.summary =
      "Pairs each point with the point nearest to the line along its normal: for two sheets at a "
      "constant distance.";
  method.parameters = normal_parameters();
  method.preprocessing = Preprocessing::none();
  method.run = run_normals_only;
  return method;
}

}  // namespace symsurf
