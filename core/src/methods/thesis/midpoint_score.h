#pragma once

#include <symsurf/context.h>
#include <symsurf/result.h>

#include "spatial/point_tree.h"

namespace symsurf {

/// The score, 0 to 1, of pairs without a mirror (the thesis's Algorithms 1 to
/// 3): the share of the points that a smooth surface through the midpoints
/// mirrors onto their partners.
///
/// To within the spacing of the points; points nearer to the surface than that
/// do not count. The tree is that of the points.
double midpoint_score(PointsView points, const PointTree& tree, const Result& result,
                      const Context& context);

}  // namespace symsurf
