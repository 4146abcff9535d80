#pragma once

#include <symsurf/points.h>

namespace symsurf {

/// Three points each make a triangle.
inline Triangles triangle_soup(const Points& points) {
  Triangles faces(points.rows() / 3, 3);
  for (Index f = 0; f < faces.rows(); ++f) faces.row(f) << 3 * f, 3 * f + 1, 3 * f + 2;
  return faces;
}

}  // namespace symsurf
