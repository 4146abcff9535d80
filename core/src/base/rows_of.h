#pragma once

#include <symsurf/types.h>

#include <array>
#include <vector>

namespace symsurf {

/// Points, or triangles, as the rows of a matrix.
inline Points rows_of(const std::vector<Vector3>& points) {
  Points rows(static_cast<Index>(points.size()), 3);
  for (Index i = 0; i < rows.rows(); ++i) rows.row(i) = points[i].transpose();
  return rows;
}

inline Triangles rows_of(const std::vector<std::array<Index, 3>>& triangles) {
  Triangles rows(static_cast<Index>(triangles.size()), 3);
  for (Index i = 0; i < rows.rows(); ++i)
    rows.row(i) << triangles[i][0], triangles[i][1], triangles[i][2];
  return rows;
}

}  // namespace symsurf
