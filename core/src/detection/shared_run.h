#pragma once

#include <symsurf/detect.h>

namespace symsurf {

/// detect() on a point set that the context's processes share out. Collective.
Result detect_shared(PointsView own, const Options& options, const Method& method,
                     const ParameterValues& values, const Context& context);

}  // namespace symsurf
