#pragma once

#include <symsurf/context.h>
#include <symsurf/detect.h>

#include "search/registry.h"

namespace symsurf {

/// detect() of points that are all in this process.
Result detect_in_one(PointsView points, const Options& options, const MethodImplementation& method,
                     const ParameterValues& values, const Context& context);

/// The same of points that the processes of the context share out, of which these are this
/// process's. The faces are not seen. Collective.
Result detect_shared(PointsView own, const Options& options, const MethodImplementation& method,
                     const ParameterValues& values, const Context& context);

}  // namespace symsurf
