#include "mirrors/mirror_mesh.h"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <vector>

#include "base/linear_algebra.h"
#include "base/math.h"
#include "cloud/cloud.h"
#include "cloud/point_tree.h"
#include "cloud/surface_points.h"

namespace symsurf {

namespace {

using Cell = std::array<int, 3>;

Cell next(Cell c, int axis, int by) {
  c[axis] += by;
  return c;
}

}  // namespace

Mesh surface_net(const Mirror& mirror, const std::vector<Foot>& feet, int resolution,
                 const std::function<double(const Vector3&)>& value, const Context& context) {
  Points points = points_of(feet);
  require_extent(points, "feet on the mirror");

  // A grid along the principal axes of the feet, and the feet in it: there, where rounding is that
  // of the grid and not that of its distance from the coordinates' origin, cells have different
  // middles wherever the grid lies. From the first foot: the sum of far ones may be no double.
  const Eigen::RowVector3d first = points.row(0);
  const Eigen::RowVector3d centre = first + (points.rowwise() - first).colwise().mean();
  points.rowwise() -= centre;
  const Matrix3 axes = eigen_of_scatter(points).vectors;
  points *= axes;
  const Eigen::RowVector3d low = points.colwise().minCoeff();
  double cell = (points.colwise().maxCoeff() - low).maxCoeff() / resolution;
  if (!(cell > 0)) cell = 1;
  // Half a cell off the extremes, so that flat pieces do not fall between two layers of cells.
  points = ((points.rowwise() - low) / cell).array() + 0.5;
  const auto middle = [](const Cell& c) -> Vector3 {
    return Vector3(c[0], c[1], c[2]).array() + 0.5;
  };
  const auto corner = [&](const Cell& c) -> Vector3 {
    return centre.transpose() + axes * (low.transpose() + cell * (middle(c) - Vector3::Ones()));
  };

  std::map<Cell, double> values;
  const auto at = [&](const Cell& c) {
    context.check();
    const auto [entry, fresh] = values.try_emplace(c, std::nan(""));
    if (fresh) entry->second = value(corner(c));
    return entry->second;
  };
  const auto crosses = [&](const Cell& c) {
    int below = 0;
    for (int k = 0; k < 8; ++k) {
      const double v = at({c[0] + (k & 1), c[1] + (k >> 1 & 1), c[2] + (k >> 2)});
      if (!std::isfinite(v)) return false;
      below += v < 0;
    }
    return below > 0 && below < 8;
  };

  std::map<Cell, Index> vertex_of;  // cells of the net; -1 until they get a vertex
  for (const auto& point : points.rowwise()) {
    const Eigen::Array3i c = point.array().floor().cast<int>();
    for (int k = 0; k < 27; ++k)
      vertex_of[{c[0] + k % 3 - 1, c[1] + k / 3 % 3 - 1, c[2] + k / 9 - 1}] = -1;
  }
  // Between points spread over a surface there are no gaps as wide; both points of an exact pair
  // stand at one position.
  constexpr double gap = 1.4;  // spacings
  const PointTree tree(points);
  const double reach = std::max(1.0, gap * surface_spacing(points, tree, 2));
  std::vector<Cell> open;
  for (const auto& [c, vertex] : vertex_of) open.push_back(c);
  while (!open.empty()) {
    const Cell c = open.back();
    open.pop_back();
    if (!crosses(c)) continue;
    for (int axis = 0; axis < 3; ++axis)
      for (const int by : {-1, 1}) {
        const Cell beside = next(c, axis, by);
        if (vertex_of.contains(beside) || tree.nearest(middle(beside), reach * reach).index < 0)
          continue;
        vertex_of[beside] = -1;
        open.push_back(beside);
      }
  }

  std::vector<Vector3> vertices;
  for (auto& [c, vertex] : vertex_of) {
    if (!crosses(c)) continue;
    Vector3 sum = Vector3::Zero();
    int crossings = 0;
    for (int axis = 0; axis < 3; ++axis)
      for (int k = 0; k < 4; ++k) {
        const Cell a = next(next(c, (axis + 1) % 3, k & 1), (axis + 2) % 3, k >> 1),
                   b = next(a, axis, 1);
        const double fa = at(a), fb = at(b);
        if ((fa < 0) == (fb < 0)) continue;
        sum += corner(a) + fa / (fa - fb) * (corner(b) - corner(a));
        ++crossings;
      }
    vertex = static_cast<Index>(vertices.size());
    const Vector3 near = sum / crossings, on = mirror.foot(near);
    vertices.push_back((on - near).norm() < cell ? on : near);
  }

  const auto number = [&](const Cell& c) {
    const auto found = vertex_of.find(c);
    return found == vertex_of.end() ? -1 : found->second;
  };
  std::vector<std::array<Index, 3>> triangles;
  for (const auto& [c, vertex] : vertex_of)
    for (int axis = 0; axis < 3 && vertex >= 0; ++axis) {
      const bool is_below = at(c) < 0;
      if (is_below == (at(next(c, axis, 1)) < 0)) continue;
      // The four cells around the edge from c along the axis.
      const Cell beside = next(c, (axis + 1) % 3, -1);
      const int other = (axis + 2) % 3;
      Index a = number(beside), b = number(next(c, other, -1));
      const Index across = number(next(beside, other, -1));
      if (std::min({a, b, across}) < 0) continue;
      if (is_below) std::swap(a, b);  // triangles face the side where the function is positive
      triangles.push_back({vertex, a, across});
      triangles.push_back({vertex, across, b});
    }

  return {rows_of(vertices), rows_of(triangles)};
}

}  // namespace symsurf
