#pragma once

#include "operations/operation.h"

namespace symsurf {

/// The completion with turns about an axis as well, where the parameter "symmetry" asks for them:
/// turn after turn of what is there by then, each the least that lays most of the shape where it
/// lacks something.
OperationImplementation also_about_axis(OperationImplementation completion);

}  // namespace symsurf
