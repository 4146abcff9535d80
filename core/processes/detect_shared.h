#pragma once

#include <symsurf/context.h>
#include <symsurf/detect.h>

#include "pairing/matching.h"
#include "search/methods.h"
#include "slabs.h"

namespace symsurf {

/// detect() of points that the processes of the context share out, of which these are this
/// process's. The faces are not seen. Collective.
Result detect_shared(PointsView own, const Options& options, const MethodImplementation& method,
                     const ParameterValues& values, const Context& context);

/// Pairs the points of this process, of which the slabs were made, with those of all, numbered
/// through all processes, where an image is no farther than `limit` (input units) from its partner.
/// `tree`: of this process's slab. An image in or near another slab is sent to its process, so
/// memory grows with the own points only. Collective.
void add_pairs(Result& result, PointsView own, const Slabs& slabs, PointTree&& tree, double limit,
               const Context& context);

}  // namespace symsurf
