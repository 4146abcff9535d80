#pragma once

#include "cloud/cloud.h"
#include "distributed/slabs.h"
#include "score/matching.h"

namespace symsurf {

/// Pairs the points of this process with those of all, numbered through all processes.
/// `tree`: of this process's slab. An image in or near another slab is sent to its process, so
/// memory grows with the own points only. Collective; that of matching.h in one process.
void add_pairs(Result& result, const Cloud& cloud, const Slabs& slabs, PointTree&& tree,
               const ParameterValues& values, const Context& context);

}  // namespace symsurf
