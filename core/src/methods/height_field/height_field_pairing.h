#pragma once

#include <utility>
#include <vector>

#include "methods/height_field/working_cloud.h"

namespace symsurf {

using ChordPair = std::pair<Index, Index>;

/// Pairs of points that lie over each other along the direction within `tolerance`: no plane need
/// separate them. Of 2k points on one line the first goes with the last, the second with the last
/// but one: nested, all with one midpoint.
std::vector<ChordPair> nested_pairs(const WorkingCloud& cloud, const Vector3& direction,
                                    double tolerance);

/// The direction that all the pairs' chords share best: least squares of their offsets across it.
Vector3 common_direction(const WorkingCloud& cloud, const std::vector<ChordPair>& pairs);

}  // namespace symsurf
