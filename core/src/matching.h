#pragma once

#include <symsurf/context.h>
#include <symsurf/mirror.h>
#include <symsurf/result.h>

#include <vector>

#include "point_tree.h"

namespace symsurf {

/// Fills the result's pairs, residuals and surface points: for each point the nearest of the tree's
/// points (the same cloud) to its image, where that is no farther than `limit` (input units). In
/// the order of the points; equally near partners: the lowest index. Frees the tree as soon as
/// partners are known: it and the pairs never need memory together. Where processes share out the
/// cloud: for each own point, among the points of all.
void add_pairs(Result& result, PointsView points, PointTree&& tree, const Mirror& mirror,
               double limit, const Context& context);

/// Keeps these rows of the result's pairs, residuals and surface points.
void keep_pairs(Result& result, const std::vector<Index>& rows);

}  // namespace symsurf
