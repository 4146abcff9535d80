#pragma once

#include <symsurf/context.h>
#include <symsurf/result.h>

#include "spatial/point_tree.h"

namespace symsurf {

/// How well pairs without a mirror describe one, 0 to 1: the share of the points that a smooth
/// sheet through the neighbouring surface points mirrors onto their partners, to within the spacing
/// of the points; points nearer to the sheet than that do not count. The tree is that of the
/// points.
double sheet_score(PointsView points, const PointTree& tree, const Result& result,
                   const Context& context);

}  // namespace symsurf
