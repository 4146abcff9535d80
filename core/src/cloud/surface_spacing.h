#pragma once

#include "spatial/point_tree.h"

namespace symsurf {

/// Spacing of points spread over surfaces, in input units: from the median distance to the sixth
/// neighbour, since a disc of that radius holds six. Where every position holds `copies` points,
/// the distance to the sixth position. 0 where most points coincide.
double surface_spacing(PointsView points, const PointTree& tree, Index copies = 1);

/// The same about one of the points, from its neighbourhood: itself, then others, nearest first.
double spacing_at(const std::vector<Neighbour>& neighbourhood);

}  // namespace symsurf
