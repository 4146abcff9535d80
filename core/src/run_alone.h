#pragma once

#include <symsurf/detect.h>

namespace symsurf {

/// Checks the points and runs the method on them: where many are copies, on the places they stand
/// in, and where they fill bodies, on the skin, unless the method sees copies, or the inside,
/// itself. For a process that has all points.
Result run_alone(PointsView points, PointsView normals, std::uint64_t seed, const Method& method,
                 const ParameterValues& values, const Context& context);

}  // namespace symsurf
