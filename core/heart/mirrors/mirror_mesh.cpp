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

// A grid along the principal axes of the points, and the points in it: there, where rounding is
// that of the grid and not that of its distance from the coordinates' origin, cells have different
// middles wherever the grid lies.
struct Grid {
  Vector3 origin;
  Matrix3 axes;
  double cell = 0;
  Points points;

  Vector3 corner(const Cell& c) const { return origin + axes * (cell * Vector3(c[0], c[1], c[2])); }
  Vector3 middle(const Cell& c) const { return cell * Vector3(c[0] + 0.5, c[1] + 0.5, c[2] + 0.5); }
  Cell cell_of(Index i) const {
    const auto at = [&](int axis) { return static_cast<int>(std::floor(points(i, axis) / cell)); };
    return {at(0), at(1), at(2)};
  }
};

Grid grid_along(const Points& points, int resolution) {
  Grid grid;
  // From the first: the sum of far coordinates may be no double.
  const Eigen::RowVector3d first = points.row(0);
  const Eigen::RowVector3d centre = first + (points.rowwise() - first).colwise().mean();
  const Points centred = points.rowwise() - centre;
  grid.axes = eigen_of_scatter(centred).vectors;
  grid.points = centred * grid.axes;
  const Vector3 low = grid.points.colwise().minCoeff(), high = grid.points.colwise().maxCoeff();
  const double longest = (high - low).maxCoeff();
  grid.cell = longest / resolution;
  if (!(grid.cell > 0)) grid.cell = 1;
  // Half a cell off the extremes, so that flat pieces do not fall between two layers of cells.
  const Vector3 start = low - Vector3::Constant(grid.cell / 2);
  grid.origin = centre.transpose() + grid.axes * start;
  grid.points.rowwise() -= start.transpose();
  return grid;
}

Cell moved(Cell c, int axis, int by) {
  c[axis] += by;
  return c;
}

}  // namespace

Mesh surface_net(const Points& on_surface, int resolution,
                 const std::function<double(const Vector3&)>& value,
                 const std::function<Vector3(const Vector3&)>& foot, const Context& context) {
  require_extent(on_surface, "feet on the mirror");
  const Grid grid = grid_along(on_surface, resolution);
  std::map<Cell, Index> vertex_of;  // cells of the net; -1 until they get a vertex
  for (Index i = 0; i < on_surface.rows(); ++i) {
    const Cell c = grid.cell_of(i);
    for (int x = -1; x <= 1; ++x)
      for (int y = -1; y <= 1; ++y)
        for (int z = -1; z <= 1; ++z) vertex_of[{c[0] + x, c[1] + y, c[2] + z}] = -1;
  }

  std::map<Cell, double> values;
  const auto at = [&](const Cell& c) {
    context.check();
    const auto [entry, fresh] = values.try_emplace(c, std::nan(""));
    if (fresh) entry->second = value(grid.corner(c));
    return entry->second;
  };
  const auto crosses = [&](const Cell& c) {
    int below = 0;
    for (int corner = 0; corner < 8; ++corner) {
      const double v = at({c[0] + (corner & 1), c[1] + (corner >> 1 & 1), c[2] + (corner >> 2)});
      if (!std::isfinite(v)) return false;
      below += v < 0;
    }
    return below > 0 && below < 8;
  };

  // Between points spread over a surface there are no gaps as wide; both points of an exact pair
  // stand at one position.
  constexpr double gap = 1.4;  // spacings
  const PointTree tree(grid.points);
  const double reach = std::max(grid.cell, gap * surface_spacing(grid.points, tree, 2));
  std::vector<Cell> open;
  for (const auto& entry : vertex_of) open.push_back(entry.first);
  while (!open.empty()) {
    const Cell c = open.back();
    open.pop_back();
    if (!crosses(c)) continue;
    for (int axis = 0; axis < 3; ++axis)
      for (const int by : {-1, 1}) {
        const Cell next = moved(c, axis, by);
        if (vertex_of.contains(next)) continue;
        if (tree.nearest(grid.middle(next), reach * reach).index < 0) continue;
        vertex_of[next] = -1;
        open.push_back(next);
      }
  }

  std::vector<Vector3> vertices;
  for (auto& [c, vertex] : vertex_of) {
    Vector3 sum = Vector3::Zero();
    int crossings = 0;
    bool defined = true;
    for (int axis = 0; axis < 3; ++axis)
      for (int corner = 0; corner < 4; ++corner) {
        Cell a = moved(c, (axis + 1) % 3, corner & 1);
        a = moved(a, (axis + 2) % 3, corner >> 1);
        const Cell b = moved(a, axis, 1);
        const double fa = at(a), fb = at(b);
        defined = defined && std::isfinite(fa) && std::isfinite(fb);
        if (!defined || (fa < 0) == (fb < 0)) continue;
        sum += grid.corner(a) + fa / (fa - fb) * (grid.corner(b) - grid.corner(a));
        ++crossings;
      }
    if (!defined || crossings == 0) continue;
    vertex = static_cast<Index>(vertices.size());
    const Vector3 near = sum / crossings, on = foot(near);
    vertices.push_back((on - near).norm() < grid.cell ? on : near);
  }

  std::vector<std::array<Index, 3>> triangles;
  for (const auto& [c, vertex] : vertex_of) {
    if (vertex < 0) continue;
    for (int axis = 0; axis < 3; ++axis) {
      const double fa = at(c), fb = at(moved(c, axis, 1));
      if (!std::isfinite(fa) || !std::isfinite(fb) || (fa < 0) == (fb < 0)) continue;
      // The four cells around the edge from c along the axis.
      const int u = (axis + 1) % 3, v = (axis + 2) % 3;
      const std::array<Cell, 4> around{c, moved(c, u, -1), moved(moved(c, u, -1), v, -1),
                                       moved(c, v, -1)};
      std::array<Index, 4> q{};
      bool complete = true;
      for (int k = 0; k < 4; ++k) {
        const auto found = vertex_of.find(around[k]);
        complete = complete && found != vertex_of.end() && found->second >= 0;
        if (complete) q[k] = found->second;
      }
      if (!complete) continue;
      if (fa < 0) std::swap(q[1], q[3]);  // triangles face the side where the function is positive
      triangles.push_back({q[0], q[1], q[2]});
      triangles.push_back({q[0], q[2], q[3]});
    }
  }

  return {rows_of(vertices), rows_of(triangles)};
}

}  // namespace symsurf
