#pragma once

#include <symsurf/detect.h>
#include <symsurf/method.h>

namespace symsurf {

/// Validates the points and runs a method on them, after the pre-processing that it asks for:
/// points that are not finite, strays, samples of the faces, copies, the skin of bodies. All of it
/// in this process.
Result run_alone(PointsView points, const Options& options, const Method& method,
                 const ParameterValues& values, const Context& context);

}  // namespace symsurf
