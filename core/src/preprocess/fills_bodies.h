#pragma once

#include <symsurf/context.h>
#include <symsurf/method.h>

namespace symsurf {

/// Do the points fill bodies, as the voxels of a mask do, in place of lying on surfaces? Collective
/// where several processes share them out: the same answer as one gets of all.
bool fills_bodies(const Cloud& cloud, const Context& context);

}  // namespace symsurf
