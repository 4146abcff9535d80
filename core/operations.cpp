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
  static constexpr Matchers matchers{homologous_points, topological_pairs, vertex_pairs};
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
  return run_operation(operation_implementation(name), input, mirror, parameters, context);
}

}  // namespace symsurf
