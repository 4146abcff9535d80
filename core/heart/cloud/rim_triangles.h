#pragma once

#include <symsurf/context.h>
#include <symsurf/points.h>

#include <vector>

namespace symsurf {

/// Triangles that fill a closed loop of points, wound as it runs: of all triangulations the one of
/// the least area (Barequet and Sharir, 1995). Takes time by the cube of its length.
Triangles loop_triangulation(PointsView points, const std::vector<Index>& loop);

/// Triangles that join two chains of points, which run side by side: of all strips the one whose
/// cross edges are shortest in sum (Fuchs, Kedem and Uselton, 1977, for the search). Each triangle
/// has one edge of a chain, of `left` from first to last, of `right` from last to first. Of closed
/// chains the last point is the first again. Takes time and a bit by the product of their lengths;
/// where that is more than 10^9 the shorter of two cross edges is taken at each step.
Triangles strip_between(PointsView points, const std::vector<Index>& left,
                        const std::vector<Index>& right, const Context& context = {});

}  // namespace symsurf
