#pragma once

#include <symsurf/operations.h>

#include "operations/symmetry_map.h"

namespace symsurf {

/// Makes the result the shape itself, the source of each point and face its own.
void start_completion(const OperationInput& input, OperationResult& result);

/// Adds to the shape in `result` the preimages under a map of what they are missing from.
void complete_by(const SymmetryMap& map, const ParameterValues& values, const Context& context,
                 OperationResult& result);

}  // namespace symsurf
