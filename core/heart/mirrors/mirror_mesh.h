#pragma once

#include <symsurf/mirror.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <vector>

#include "base/math.h"

namespace symsurf {

struct GridCells {
  int columns, rows;
};

/// About square, `resolution` of them along the longer side; one where that is no length.
inline GridCells grid_cells(double width, double height, int resolution) {
  const double cell = std::max(width, height) / resolution;
  const auto along = [&](double length) {
    return cell > 0 && std::isfinite(cell)
               ? std::max(1, static_cast<int>(std::ceil(length / cell - 1e-9)))
               : 1;
  };
  return {along(width), along(height)};
}

/// Triangulates surface(s, t) over the unit square.
template <typename Surface>
Mesh grid_mesh(const GridCells& cells, const Context& context, const Surface& surface) {
  const auto [columns, rows] = cells;
  Mesh mesh;
  mesh.vertices.resize(static_cast<Index>(columns + 1) * (rows + 1), 3);
  mesh.triangles.resize(static_cast<Index>(columns) * rows * 2, 3);
  for (int r = 0; r <= rows; ++r) {
    context.check();
    for (int c = 0; c <= columns; ++c)
      mesh.vertices.row(r * (columns + 1) + c) =
          surface(static_cast<double>(c) / columns, static_cast<double>(r) / rows).transpose();
  }
  Index t = 0;
  for (int r = 0; r < rows; ++r)
    for (int c = 0; c < columns; ++c) {
      const Index a = r * (columns + 1) + c, b = a + 1, d = a + columns + 1, e = d + 1;
      mesh.triangles.row(t++) << a, b, e;
      mesh.triangles.row(t++) << a, e, d;
    }
  return mesh;
}

/// The triangles for which keep(number) is true, and their vertices.
template <typename Keep>
Mesh part_of(const Mesh& mesh, const Keep& keep) {
  std::vector<Index> number(mesh.vertices.rows(), -1), vertices;
  std::vector<std::array<Index, 3>> triangles;
  for (Index t = 0; t < mesh.triangles.rows(); ++t) {
    if (!keep(t)) continue;
    std::array<Index, 3>& corners = triangles.emplace_back();
    for (int c = 0; c < 3; ++c) {
      Index& vertex = number[mesh.triangles(t, c)];
      if (vertex < 0) {
        vertex = static_cast<Index>(vertices.size());
        vertices.push_back(mesh.triangles(t, c));
      }
      corners[c] = vertex;
    }
  }
  return {mesh.vertices(vertices, Eigen::indexing::all), rows_of(triangles)};
}

/// Triangulates the zero set of `value` around the given points on it: surface nets (Gibson 1998)
/// on a grid along the points' principal axes, `resolution` cells along the longest, in cells that
/// hold a point or touch one that does, and from there on as far as the points stand from each
/// other. `value` is NaN where the function is not defined. Vertices are moved to their feet, where
/// they have one near by. Throws InvalidInput for points that extend over more than 1e50, where
/// squared distances no longer bound the net.
Mesh surface_net(const Points& on_surface, int resolution,
                 const std::function<double(const Vector3& x)>& value,
                 const std::function<Vector3(const Vector3& x)>& foot, const Context& context);

}  // namespace symsurf
