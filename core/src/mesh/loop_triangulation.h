#pragma once

#include <symsurf/points.h>

#include <vector>

namespace symsurf {

/// Triangles that fill a closed loop of points, wound as it runs: of all triangulations the one of
/// the least area (Barequet and Sharir, 1995). Takes time by the cube of its length.
Triangles loop_triangulation(PointsView points, const std::vector<Index>& loop);

}  // namespace symsurf
