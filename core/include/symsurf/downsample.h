#pragma once

#include <symsurf/context.h>
#include <symsurf/points_view.h>

namespace symsurf {

/// The simplification of Hruda et al. (2022): a grid of cells l_avg / k, anchored at the bounding
/// box's minimum, k = 1, 2, 3, ... until at least `count` cells are occupied (l_avg: the mean
/// distance of the points from their centroid); the mean of each occupied cell, in lexicographic
/// order of the cells. With `count` or fewer distinct points, these points themselves, in
/// lexicographic order.
/// From 128 on k grows by a 64th of the power of two below it, so that far outliers cost little,
/// and no farther than 2^51 cells along the box's longest side: points nearer to each other are
/// one, and fewer than `count` come out.
/// Throws InvalidInput for no points or NaN, InvalidParameter for a count below 1, and Cancelled.
Points downsample(PointsView points, Index count, const Context& context = {});

}  // namespace symsurf
