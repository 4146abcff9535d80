#pragma once

#include <cmath>

namespace symsurf {

/// What takes lengths to a unit, a power of two, in which the extent is 1 to 2: single precision
/// then holds them and their squares, rounded alike, whatever the input's unit.
inline double to_binary_unit(double extent) {
  return extent > 0 ? std::ldexp(1, -std::ilogb(extent)) : 1;
}

}  // namespace symsurf
