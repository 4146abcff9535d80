#pragma once

#include <symsurf/mirror.h>

namespace symsurf {

/// Triangulates surface(s, t) over the unit square, columns x rows cells.
template <typename Surface>
Mesh grid_mesh(int columns, int rows, const Surface& surface) {
  Mesh mesh;
  mesh.vertices.resize(static_cast<Index>(columns + 1) * (rows + 1), 3);
  mesh.triangles.resize(static_cast<Index>(columns) * rows * 2, 3);
  for (int r = 0; r <= rows; ++r)
    for (int c = 0; c <= columns; ++c)
      mesh.vertices.row(r * (columns + 1) + c) =
          surface(static_cast<double>(c) / columns, static_cast<double>(r) / rows).transpose();
  Index t = 0;
  for (int r = 0; r < rows; ++r)
    for (int c = 0; c < columns; ++c) {
      const Index a = r * (columns + 1) + c, b = a + 1, d = a + columns + 1, e = d + 1;
      mesh.triangles.row(t++) << a, b, e;
      mesh.triangles.row(t++) << a, e, d;
    }
  return mesh;
}

}  // namespace symsurf
