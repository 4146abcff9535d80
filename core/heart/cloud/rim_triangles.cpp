#include "cloud/rim_triangles.h"

#include <algorithm>

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

namespace {

constexpr std::size_t most_edges = 1'000'000'000;  // compared, a bit each: 125 MB

// The shorter cross edge at each step (Christiansen and Sederberg 1978): for chains too long to
// compare all strips.
Triangles strip_by_shorter_edges(PointsView points, const std::vector<Index>& left,
                                 const std::vector<Index>& right, const Context& context) {
  std::vector<std::array<Index, 3>> triangles;
  for (std::size_t i = 0, j = 0; i + 1 < left.size() || j + 1 < right.size();) {
    context.check();
    const auto length = [&](std::size_t a, std::size_t b) {
      return a < left.size() && b < right.size() ? (points[left[a]] - points[right[b]]).norm()
                                                 : infinity;
    };
    if (length(i + 1, j) < length(i, j + 1)) {
      triangles.push_back({left[i], left[i + 1], right[j]});
      ++i;
    } else {
      triangles.push_back({right[j + 1], right[j], left[i]});
      ++j;
    }
  }
  return rows_of(triangles);
}

}  // namespace

Triangles strip_between(PointsView points, const std::vector<Index>& left,
                        const std::vector<Index>& right, const Context& context) {
  if (left.size() > most_edges / right.size())
    return strip_by_shorter_edges(points, left, right, context);
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
