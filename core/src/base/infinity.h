#pragma once

#include <limits>

namespace symsurf {

constexpr double infinity = std::numeric_limits<double>::infinity();

}  // namespace symsurf
