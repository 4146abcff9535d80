#pragma once

#include "score/matching.h"
#include "spatial/slabs.h"

namespace symsurf {

/// add_pairs() of this process's part of the cloud with the points of all processes, numbered
/// through. They are looked for in the slabs, of which the tree is of this process's: images in or
/// near another are sent there, and memory does not grow with what others have. Collective; alone
/// it is add_pairs().
void add_shared_pairs(Result& result, const Cloud& cloud, const Slabs& slabs, PointTree&& tree,
                      const Mirror& mirror, double limit, const Context& context);

}  // namespace symsurf
