#pragma once

#include <symsurf/context.h>
#include <symsurf/method.h>
#include <symsurf/result.h>

namespace symsurf {

/// Pairs all points of a cloud over the mirror that was found of some of them, or of others on the
/// same surface: pairs, residuals, surface points, and the statistics of these. `values`: of the
/// method's parameters, where the result does not have them.
void match_again(Result& result, const Cloud& cloud, const ParameterValues& values,
                 const Context& context);

}  // namespace symsurf
