#pragma once

#include <symsurf/mirror.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "base/math.h"

namespace symsurf {

inline Points points_of(const std::vector<Foot>& feet) {
  Points points(static_cast<Index>(feet.size()), 3);
  for (Index i = 0; i < points.rows(); ++i) points.row(i) = feet[i].point;
  return points;
}

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
          surface(static_cast<double>(c) / columns, static_cast<double>(r) / rows);
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

/// A grid over the box of coordinates, about square; surface(at) is the point at some.
template <typename Surface>
Mesh box_mesh(const Eigen::MatrixX2d& coordinates, int resolution, const Context& context,
              const Surface& surface) {
  const Eigen::Vector2d low = coordinates.colwise().minCoeff(),
                        size = coordinates.colwise().maxCoeff().transpose() - low;
  return grid_mesh(grid_cells(size.x(), size.y(), resolution), context, [&](double s, double t) {
    return surface(low + size.cwiseProduct(Eigen::Vector2d(s, t)));
  });
}

/// The triangles for which keep(number) is true, and their vertices.
template <typename Keep>
Mesh part_of(const Mesh& mesh, const Keep& keep) {
  std::vector<Index> number(mesh.vertices.rows(), -1), vertices, kept;
  for (Index t = 0; t < mesh.triangles.rows(); ++t)
    if (keep(t)) kept.push_back(t);
  Triangles triangles = mesh.triangles(kept, Eigen::indexing::all);
  std::for_each_n(triangles.data(), triangles.size(), [&](Index& corner) {
    Index& vertex = number[corner];
    if (vertex < 0) {
      vertex = static_cast<Index>(vertices.size());
      vertices.push_back(corner);
    }
    corner = vertex;
  });
  return {mesh.vertices(vertices, Eigen::indexing::all), triangles};
}

/// Triangulates a mirror, the zero set of `value`, around some of its feet: surface nets (Gibson
/// 1998) on a grid along the feet's principal axes, `resolution` cells along the longest, in cells
/// that hold a foot or touch one that does, and from there on as far as the feet stand from each
/// other. `value` is NaN where the function is not defined. Vertices are moved to their feet, where
/// they have one near by. Throws InvalidInput for feet that extend over more than 1e50, where
/// squared distances no longer bound the net.
Mesh surface_net(const Mirror& mirror, const std::vector<Foot>& feet, int resolution,
                 const std::function<double(const Vector3& x)>& value, const Context& context);

}  // namespace symsurf
