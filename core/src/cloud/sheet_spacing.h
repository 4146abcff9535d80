#pragma once

#include "spatial/point_tree.h"

namespace symsurf {

/// Spacing of points spread over sheets, in input units: from the median distance to the sixth
/// neighbour, since a disc of that radius holds six. Where every place holds `copies` points, the
/// distance to the sixth place. 0 where most points coincide.
double sheet_spacing(PointsView points, const PointTree& tree, Index copies = 1);

}  // namespace symsurf
