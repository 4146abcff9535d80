#pragma once

#include <symsurf/context.h>
#include <symsurf/result.h>

namespace symsurf {

/// Drops pairs by chance: where one side is missing, images fall on whatever lies at the gap's rim.
/// Kept is what fits about as well as most pairs do and, where most are exact, neighbours of an
/// image among exact pairs. `spacing`: of the points on a surface, in input units.
void keep_credible_pairs(Result& result, double spacing, const Context& context);

}  // namespace symsurf
