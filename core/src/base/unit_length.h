#pragma once

#include <symsurf/types.h>

#include <cmath>
#include <limits>

namespace symsurf {

/// The length of a direction, to divide it by: 1 where it differs from 1 by rounding only, so that
/// unit vectors keep their bits and a mirror made from another's numbers has the same ones.
inline double length_of(const Vector3& direction) {
  constexpr double rounding = 4 * std::numeric_limits<double>::epsilon();
  const double length = direction.norm();
  return std::abs(length - 1) <= rounding ? 1 : length;
}

}  // namespace symsurf
