#pragma once

#include <symsurf/operation.h>

#include <vector>

#include "operations/counterparts.h"

namespace symsurf {

/// For each point whether its image is missing from the shape: the surface ends before it, or lies
/// more than `max_distance` (input units) away.
std::vector<bool> missing_points(const OperationInput& input, const Counterparts& counterparts,
                                 double max_distance, const Context& context);

}  // namespace symsurf
