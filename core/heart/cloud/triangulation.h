#pragma once

#include <symsurf/context.h>
#include <symsurf/points.h>

#include <vector>

namespace symsurf {

using Points2 = Eigen::Matrix<double, Eigen::Dynamic, 2, Eigen::RowMajor>;
using Polygon = std::vector<Index>;

/// The area within a closed loop of points of a plane, negative where it runs clockwise.
double signed_area(const Points2& points, const Polygon& loop);

/// Triangles within closed loops of points of a plane, none of which cross: outer loops run
/// counterclockwise, holes clockwise. By joining each hole to its outer loop and clipping the ear
/// with the shortest diagonal (Meisters 1975). Takes time by the square of a loop's length.
Triangles polygon_triangulation(const Points2& points, const std::vector<Polygon>& loops);

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
