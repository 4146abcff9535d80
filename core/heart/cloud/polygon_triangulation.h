#pragma once

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

}  // namespace symsurf
