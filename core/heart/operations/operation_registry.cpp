#include "operations/operation_registry.h"

#include <symsurf/context.h>

#include <algorithm>
#include <cmath>

#include "base/find_named.h"
#include "base/finite_values.h"
#include "cloud/cloud.h"
#include "cloud/triangle_mesh.h"
#include "operations/counterparts.h"
#include "operations/finite_part.h"

namespace symsurf {

namespace {

const std::vector<OperationImplementation>& operation_implementations() {
  static const std::vector<OperationImplementation> all{
      asymmetry_operation(),  correspondences_operation(), align_operation(),  complete_operation(),
      symmetrize_operation(), straighten_operation(),      remesh_operation(), cut_operation(),
      transfer_operation(),   illuminate_operation()};
  return all;
}

const OperationImplementation& operation_implementation(std::string_view name) {
  return find_named(operation_implementations(), name, "operation");
}

bool is_over_mirror(const OperationImplementation& operation, const ParameterValues& values) {
  return !operation.run_about_axis || values.choice("symmetry") != "axis";
}

void require_mask(const Operation& operation, const Eigen::VectorXd& mask, Index points) {
  if (mask.size() == 0) return;
  if (!operation.takes_mask) throw InvalidInput(operation.name + " takes no mask");
  if (mask.size() != points)
    throw InvalidInput(std::to_string(mask.size()) + " mask values given for " +
                       std::to_string(points) + " points; one a point is needed");
  for (Index i = 0; i < mask.size(); ++i)
    if (!(mask[i] >= 0 && mask[i] <= 1))
      throw InvalidInput("mask value " + std::to_string(i) + " is " + to_string(Value(mask[i])) +
                         "; allowed is 0 to 1");
}

// Whether the mirror is that of another unit or pose. Where one point is farther from it than this,
// none is near.
void require_near(PointsView points, const Mirror& mirror) {
  constexpr double farthest = 10;  // diagonals: a mirror between two objects is nearer
  const double distance = std::abs(mirror.signed_distance(points[0]));
  const double diagonal = diagonal_of(points);
  if (distance > farthest * diagonal)
    throw InvalidInput("the points lie " + to_string(Value(distance / diagonal)) +
                       " diagonals away from this " + std::string(mirror.kind()) +
                       "; the mirror is to be in the unit and the pose of the points");
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

OperationResult operate(std::string_view name, const OperationInput& given, const Mirror* mirror,
                        const Values& parameters, const Context& context) {
  const OperationImplementation& operation = operation_implementation(name);
  const ParameterValues values(operation.name, operation.parameters, parameters);
  const bool takes_mirror = is_over_mirror(operation, values);
  if (takes_mirror && !mirror) throw InvalidInput(operation.name + " needs a mirror");
  require_count(given.points.size(), 1);
  require_coordinates(given.points);
  require_corners(given.faces, given.points.size());
  require_mask(operation, given.mask, given.points.size());
  const FinitePart finite(given, operation);
  const OperationInput& input = finite.input();
  if (operation.needs_faces && input.faces.empty())
    throw InvalidInput("no faces given for " + std::to_string(input.points.size()) + " points; " +
                       operation.name + " needs a mesh of triangles");
  if (takes_mirror && !operation.takes_any_mirror) require_near(input.points, *mirror);
  OperationResult result;
  result.operation = operation.name;
  result.points = input.points.matrix();
  result.faces = Eigen::Map<const Triangles>(input.faces.data(), input.faces.size(), 3);
  result.parameters = values.all();
  context.report(0);
  if (takes_mirror)
    operation.run(input, *mirror, values, context, result);
  else
    operation.run_about_axis(input, values, context, result);
  finite.map_back(result);
  drop_nonfinite(result.statistics);
  context.report(1);
  return result;
}

}  // namespace symsurf
