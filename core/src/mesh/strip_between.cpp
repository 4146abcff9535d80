#include "mesh/strip_between.h"

#include <algorithm>

#include "base/math.h"

namespace symsurf {

Triangles strip_between(PointsView points, const std::vector<Index>& left,
                        const std::vector<Index>& right, const Context& context) {
  const std::size_t rows = left.size(), columns = right.size();
  // least[j]: the sum up to the cross edge from left[i] to right[j]; from_left: its last triangle
  // has an edge of the left chain.
  std::vector<double> least(columns, infinity);
  std::vector<bool> from_left(rows * columns, false);
  for (std::size_t i = 0; i < rows; ++i) {
    context.check();
    for (std::size_t j = 0; j < columns; ++j) {
      const double above = i > 0 ? least[j] : infinity;
      const double before = j > 0 ? least[j - 1] : infinity;
      from_left[i * columns + j] = above < before;
      const double sum = i + j == 0 ? 0 : std::min(above, before);
      least[j] = sum + (points[left[i]] - points[right[j]]).norm();
    }
  }
  std::vector<std::array<Index, 3>> triangles;
  for (std::size_t i = rows - 1, j = columns - 1; i + j > 0;) {
    if (from_left[i * columns + j]) {
      triangles.push_back({left[i - 1], left[i], right[j]});
      --i;
    } else {
      triangles.push_back({right[j], right[j - 1], left[i]});
      --j;
    }
  }
  std::reverse(triangles.begin(), triangles.end());
  return rows_of(triangles);
}

}  // namespace symsurf
