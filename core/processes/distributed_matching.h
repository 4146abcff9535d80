#pragma once

#include "pairing/matching.h"
#include "slabs.h"

namespace symsurf {

/// Pairs the points of this process, of which the slabs were made, with those of all, numbered
/// through all processes, where an image is no farther than `limit` (input units) from its partner.
/// `tree`: of this process's slab. An image in or near another slab is sent to its process, so
/// memory grows with the own points only. Collective.
void add_pairs(Result& result, PointsView own, const Slabs& slabs, PointTree&& tree, double limit,
               const Context& context);

}  // namespace symsurf
