#pragma once

#include <symsurf/communicator.h>

#include "matching.h"

namespace symsurf {

/// add_pairs() of the own points with those of all processes, numbered through in the order of
/// their ranks. Images go, a chunk at a time, to the processes that may hold a nearer point; memory
/// does not grow with what the others have. Collective.
void add_shared_pairs(Result& result, PointsView own, PointTree&& tree, const Mirror& mirror,
                      double limit, const Context& context);

}  // namespace symsurf
