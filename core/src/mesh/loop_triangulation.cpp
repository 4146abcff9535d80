#include "mesh/loop_triangulation.h"

#include "base/math.h"

namespace symsurf {

Triangles loop_triangulation(PointsView points, const std::vector<Index>& loop) {
  const auto count = static_cast<Index>(loop.size());
  if (count < 3) return Triangles(0, 3);
  // Of the part between two points of the loop: its area, and the third corner at the edge that
  // joins them.
  Eigen::MatrixXd least = Eigen::MatrixXd::Zero(count, count);
  Eigen::Matrix<Index, Eigen::Dynamic, Eigen::Dynamic> third(count, count);
  for (Index width = 2; width < count; ++width)
    for (Index i = 0; i + width < count; ++i) {
      const Index k = i + width;
      least(i, k) = infinity;
      const Vector3 a = points[loop[i]], c = points[loop[k]];
      for (Index j = i + 1; j < k; ++j) {
        const double area = (points[loop[j]] - a).cross(c - a).norm() / 2;
        const double sum = least(i, j) + least(j, k) + area;
        if (sum >= least(i, k)) continue;
        least(i, k) = sum;
        third(i, k) = j;
      }
    }
  std::vector<std::array<Index, 3>> triangles;
  std::vector<std::pair<Index, Index>> open{{0, count - 1}};
  while (!open.empty()) {
    const auto [i, k] = open.back();
    open.pop_back();
    if (k - i < 2) continue;
    const Index j = third(i, k);
    triangles.push_back({loop[i], loop[j], loop[k]});
    open.push_back({i, j});
    open.push_back({j, k});
  }
  return rows_of(triangles);
}

}  // namespace symsurf
