#pragma once

#include <symsurf/context.h>
#include <symsurf/method.h>
#include <symsurf/mirror.h>
#include <symsurf/points_view.h>
#include <symsurf/result.h>

namespace symsurf {

/// Pairs every point with the input point nearest to its image over a known mirror, where that is
/// nearer than `pair_distance` times the diagonal: how a mirror found elsewhere, or one of
/// Result::candidates, fits. Equally near partners: the lowest index. Points far off the rest have
/// no partners, as in detect, and do not count for the diagonal; nor do points that are not finite,
/// which `refuse_nonfinite` makes an error. The score and the verdict are those that detect gives.
/// `tolerance`: of diagonals, as the parameter of that name of every method. Throws InvalidInput
/// and Cancelled as detect does, InvalidParameter for a negative distance and a tolerance beyond
/// [1e-4, 0.1].
Result match(PointsView points, const Mirror& mirror, double pair_distance = 0.05,
             const Context& context = {}, bool refuse_nonfinite = false,
             double tolerance = usual_tolerance);

}  // namespace symsurf
