#pragma once

#include <symsurf/types.h>

#include <string>

namespace symsurf {

/// The name of a motion, reflection or similarity, as Transformation::kind has it. What differs by
/// less than the tolerances, in radians and input units, is the same. `centre`: of the shape, where
/// a turn that is none moves nothing far.
std::string kind_of(const Matrix4& matrix, const Vector3& centre, double angle_tolerance,
                    double length_tolerance);

}  // namespace symsurf
