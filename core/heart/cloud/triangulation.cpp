#include "cloud/triangulation.h"

#include <algorithm>
#include <numeric>
#include <queue>

#include "base/math.h"

namespace symsurf {

namespace {

using Vector2 = Eigen::Vector2d;

// Twice the signed area of a triangle.
double turn(const Vector2& a, const Vector2& b, const Vector2& c) {
  return (b - a).x() * (c - a).y() - (b - a).y() * (c - a).x();
}

class Polygons {
 public:
  explicit Polygons(const Points2& points) : points_(points) {}

  // By how often a ray crosses it.
  bool is_inside(const Vector2& x, const Polygon& loop) const {
    bool inside = false;
    for (std::size_t k = 0; k < loop.size(); ++k) {
      const Vector2 a = at(loop[k]), b = at(loop[(k + 1) % loop.size()]);
      if ((a.y() > x.y()) != (b.y() > x.y()) &&
          x.x() < a.x() + (x.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x()))
        inside = !inside;
    }
    return inside;
  }

  // Joins a hole to a loop by the shortest bridge that crosses no edge of the two.
  void join(Polygon& loop, const Polygon& hole) const {
    const auto start = std::max_element(hole.begin(), hole.end(),
                                        [&](Index a, Index b) { return at(a).x() < at(b).x(); });
    const Vector2 x = at(*start);
    std::vector<std::size_t> order(loop.size());
    std::iota(order.begin(), order.end(), 0);
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      const double to_a = (at(loop[a]) - x).squaredNorm(), to_b = (at(loop[b]) - x).squaredNorm();
      return to_a < to_b || (to_a == to_b && a < b);
    });
    const auto is_free = [&](std::size_t k) {
      const Vector2 y = at(loop[k]);
      return is_within_corner(loop, k, x) && !crosses(x, y, loop) && !crosses(x, y, hole);
    };
    const auto chosen = std::find_if(order.begin(), order.end(), is_free);
    const std::size_t at_loop = chosen == order.end() ? order.front() : *chosen;
    Polygon bridge(start, hole.end());
    bridge.insert(bridge.end(), hole.begin(), start + 1);
    bridge.push_back(loop[at_loop]);
    loop.insert(loop.begin() + static_cast<std::ptrdiff_t>(at_loop) + 1, bridge.begin(),
                bridge.end());
  }

  // Appends the triangles of a loop.
  void clip(const Polygon& loop, std::vector<std::array<Index, 3>>& triangles) const {
    const std::size_t count = loop.size();
    std::vector<std::size_t> next(count), previous(count);
    for (std::size_t k = 0; k < count; ++k) {
      next[k] = (k + 1) % count;
      previous[next[k]] = k;
    }
    struct Ear {
      double diagonal;
      std::size_t corner, before, after;
      bool operator<(const Ear& other) const {  // the shortest comes first
        return diagonal > other.diagonal || (diagonal == other.diagonal && corner > other.corner);
      }
    };
    std::priority_queue<Ear> ears;
    const auto offer = [&](std::size_t k) {
      const std::size_t a = previous[k], c = next[k];
      ears.push({(at(loop[a]) - at(loop[c])).norm(), k, a, c});
    };
    const auto is_ear = [&](std::size_t k) {
      const Vector2 a = at(loop[previous[k]]), b = at(loop[k]), c = at(loop[next[k]]);
      if (turn(a, b, c) < 0) return false;
      for (std::size_t o = next[next[k]]; o != previous[k]; o = next[o]) {
        const Vector2 x = at(loop[o]);
        if (x == a || x == b || x == c) continue;
        if (turn(a, b, x) >= 0 && turn(b, c, x) >= 0 && turn(c, a, x) >= 0) return false;
      }
      return true;
    };
    std::vector<bool> is_clipped(count, false);
    std::size_t left = count;
    const auto clip_at = [&](std::size_t k) {
      triangles.push_back({loop[previous[k]], loop[k], loop[next[k]]});
      is_clipped[k] = true;
      next[previous[k]] = next[k];
      previous[next[k]] = previous[k];
      --left;
      offer(previous[k]);
      offer(next[k]);
    };
    for (std::size_t k = 0; k < count; ++k) offer(k);
    std::size_t any = 0;
    while (left > 2) {
      if (ears.empty()) {  // rounding: loops that touch themselves
        while (is_clipped[any]) any = (any + 1) % count;
        clip_at(any);
        continue;
      }
      const Ear ear = ears.top();
      ears.pop();
      if (is_clipped[ear.corner] || previous[ear.corner] != ear.before ||
          next[ear.corner] != ear.after)
        continue;
      if (is_ear(ear.corner)) clip_at(ear.corner);
    }
  }

 private:
  Vector2 at(Index i) const { return points_.row(i).transpose(); }

  bool is_within_corner(const Polygon& loop, std::size_t k, const Vector2& x) const {
    const std::size_t count = loop.size();
    const Vector2 a = at(loop[(k + count - 1) % count]), b = at(loop[k]),
                  c = at(loop[(k + 1) % count]);
    const bool left_of_both = turn(a, b, x) > 0 && turn(b, c, x) > 0;
    const bool left_of_one = turn(a, b, x) > 0 || turn(b, c, x) > 0;
    return turn(a, b, c) > 0 ? left_of_both : left_of_one;
  }

  bool crosses(const Vector2& x, const Vector2& y, const Polygon& loop) const {
    for (std::size_t k = 0; k < loop.size(); ++k) {
      const Vector2 a = at(loop[k]), b = at(loop[(k + 1) % loop.size()]);
      if (a == x || a == y || b == x || b == y) continue;
      if (turn(x, y, a) * turn(x, y, b) <= 0 && turn(a, b, x) * turn(a, b, y) <= 0) return true;
    }
    return false;
  }

  const Points2& points_;
};

}  // namespace

double signed_area(const Points2& points, const Polygon& loop) {
  const auto at = [&](std::size_t k) -> Vector2 { return points.row(loop[k]).transpose(); };
  double sum = 0;
  for (std::size_t k = 0; k < loop.size(); ++k)
    sum += turn(at(0), at(k), at((k + 1) % loop.size()));
  return sum / 2;
}

Triangles polygon_triangulation(const Points2& points, const std::vector<Polygon>& loops) {
  const Polygons polygons(points);
  std::vector<Polygon> outer;
  std::vector<const Polygon*> holes;
  for (const Polygon& loop : loops)
    if (signed_area(points, loop) >= 0)
      outer.push_back(loop);
    else
      holes.push_back(&loop);
  const std::vector<Polygon> given = outer;
  std::sort(holes.begin(), holes.end(), [&](const Polygon* a, const Polygon* b) {
    return points(*a, 0).maxCoeff() > points(*b, 0).maxCoeff();
  });
  for (const Polygon* hole : holes) {
    const Eigen::Vector2d x = points.row(hole->front()).transpose();
    std::size_t best = outer.size();
    for (std::size_t k = 0; k < given.size(); ++k)
      if (polygons.is_inside(x, given[k]) &&
          (best == outer.size() ||
           signed_area(points, given[k]) < signed_area(points, given[best])))
        best = k;
    if (best < outer.size()) polygons.join(outer[best], *hole);
  }
  std::vector<std::array<Index, 3>> triangles;
  for (const Polygon& loop : outer) polygons.clip(loop, triangles);
  return rows_of(triangles);
}

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
