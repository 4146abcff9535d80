#pragma once

#include "search/methods.h"

namespace symsurf {

/// All methods with their functions, in the order of methods().
const std::vector<MethodImplementation>& implementations();

/// Throws InvalidParameter, listing the names there are.
const MethodImplementation& implementation(std::string_view name);

}  // namespace symsurf
