#include <symsurf/analyses.h>
#include <symsurf/operations.h>

#include "base/named_values.h"
#include "homologous/homologous_points.h"
#include "light/reflection_search.h"
#include "operations/operation.h"
#include "remeshing/remeshing.h"
#include "symmetries/analysis.h"

namespace symsurf {

namespace {

const std::vector<OperationImplementation>& operation_implementations() {
  static const Matchers matchers{homologous_points, topological_pairs, vertex_pairs};
  static const std::vector<OperationImplementation> all{asymmetry_operation(matchers),
                                                        correspondences_operation(matchers),
                                                        align_operation(),
                                                        also_about_axis(complete_operation()),
                                                        symmetrize_operation(matchers),
                                                        straighten_operation(),
                                                        remesh_operation(),
                                                        cut_operation(),
                                                        transfer_operation(matchers),
                                                        illuminate_operation()};
  return all;
}

const OperationImplementation& operation_implementation(std::string_view name) {
  return find_named(operation_implementations(), name, "operation");
}

}  // namespace

const std::vector<Operation>& operations() {
  static const std::vector<Operation> all(operation_implementations().begin(),
                                          operation_implementations().end());
  return all;
}

const Operation& operation(std::string_view name) { return operation_implementation(name); }

bool OperationResult::is_other_shape() const {
  return point_parents.rows() > 0 && !symsurf::operation(operation).carries_values;
}

bool needs_mirror(std::string_view name, const Values& parameters) {
  const OperationImplementation& operation = operation_implementation(name);
  return is_over_mirror(operation, {operation.name, operation.parameters, parameters});
}

OperationResult operate(std::string_view name, const OperationInput& input, const Mirror& mirror,
                        const Values& parameters, const Context& context) {
  return operate(name, input, &mirror, parameters, context);
}

OperationResult operate(std::string_view name, const OperationInput& input, const Mirror* mirror,
                        const Values& parameters, const Context& context) {
  const OperationImplementation& operation = operation_implementation(name);
  if (input.other.empty()) return run_operation(operation, input, mirror, parameters, context);
  if (!operation.takes_other) throw InvalidInput(operation.name + " takes no second shape");
  if (mirror) throw InvalidInput("a mirror and a second shape are given; allowed is one of them");
  AnalysisOptions options;
  options.faces = input.faces;
  options.other = input.other;
  options.other_faces = input.other_faces;
  const AnalysisResult pair = analyse("match_pair", input.points, options, context.stage(0, 0.5));
  const Matrix4& map = pair.transformations.front().matrix;
  OperationResult result = run_on_pair(operation, input, map, parameters, context.stage(0.5, 1));
  const auto told = [&](const char* figure) { return pair.statistics.at(figure); };
  result.statistics["pair_score"] = told("score");
  result.statistics["pair_verdict"] = told("verdict");
  result.statistics["pair_matrix"] = Eigen::MatrixXd(map);
  if (std::get<std::string>(told("verdict")) == "none")
    result.statistics["warning"] =
        "the two shapes are no pair: " + std::get<std::string>(told("reason"));
  return result;
}

}  // namespace symsurf
