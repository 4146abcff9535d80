#pragma once

#include <symsurf/operations.h>

namespace symsurf {

/// An operation and how it runs.
struct OperationImplementation : Operation {
  /// Fills in points, arrays and statistics; the points are there already, as they were given.
  void (*run)(const OperationInput& input, const Mirror& mirror, const ParameterValues& values,
              const Context& context, OperationResult& result) = nullptr;
  /// The same about an axis, where the parameter "symmetry" says so: no mirror is needed then.
  void (*run_about_axis)(const OperationInput& input, const ParameterValues& values,
                         const Context& context, OperationResult& result) = nullptr;
};

OperationImplementation asymmetry_operation();
OperationImplementation correspondences_operation();
OperationImplementation align_operation();
OperationImplementation complete_operation();
OperationImplementation symmetrize_operation();
OperationImplementation straighten_operation();
OperationImplementation remesh_operation();
OperationImplementation cut_operation();
OperationImplementation transfer_operation();
OperationImplementation illuminate_operation();

}  // namespace symsurf
