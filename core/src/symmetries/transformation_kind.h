#pragma once

#include <symsurf/types.h>

#include <string>

namespace symsurf {

/// The name of a motion, reflection or similarity, as Transformation::kind has it. What differs by
/// less than the tolerances, in radians and input units, is the same.
std::string kind_of(const Matrix4& matrix, double angle_tolerance, double length_tolerance);

}  // namespace symsurf
