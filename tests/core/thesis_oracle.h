#pragma once

#include <symsurf/points.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

namespace symsurf::oracle {

// The thesis's Algorithms 1 to 3 as they are printed: loops over all pairs.

struct Trial {
  Vector3 direction;
  std::vector<Index> x, b;  // the points of X1 and their partners
  std::vector<double> squared;
  double error = 0, clearance = 0, score = 0;
  Index lower = 0;
};

inline double squared_from_line(const Vector3& point, const Vector3& start, const Vector3& unit) {
  const Vector3 w = point - start;
  const double along = w.x() * unit.x() + w.y() * unit.y() + w.z() * unit.z();
  const Vector3 r = w - along * unit;
  return r.x() * r.x() + r.y() * r.y() + r.z() * r.z();
}

inline std::vector<Vector3> directions() {
  std::vector<Vector3> all;
  for (int i = 0; i < 10; ++i)
    for (int j = 0; j < 10; ++j) {
      if (i == 0 && j > 0) continue;
      const double f = i * (std::numbers::pi / 10), t = j * (std::numbers::pi / 10);
      all.emplace_back(std::sin(f) * std::cos(t), std::sin(f) * std::sin(t), std::cos(f));
    }
  return all;
}

inline double clearance(PointsView points, const Trial& trial) {
  double shortest = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < trial.x.size(); ++k) {
    const Vector3 midpoint = (points[trial.x[k]] + points[trial.b[k]]) / 2;
    for (Index i = 0; i < points.size(); ++i)
      shortest = std::min(shortest, (points[i] - midpoint).norm());
  }
  return shortest;
}

// Algorithm 1 without normals; Algorithm 2 with them, as lines or as vectors.
inline Trial trial(PointsView points, const Vector3& direction, const Points* normals = nullptr,
                   bool as_lines = true) {
  Vector3 centroid = Vector3::Zero();
  for (Index i = 0; i < points.size(); ++i) centroid += points[i];
  centroid /= static_cast<double>(points.size());
  std::vector<Index> upper, lower;
  for (Index i = 0; i < points.size(); ++i)
    ((points[i] - centroid).dot(direction) > 0 ? upper : lower).push_back(i);

  Trial result;
  result.direction = direction;
  result.lower = static_cast<Index>(lower.size());
  if (lower.empty()) return result;
  for (const Index x : upper) {
    Index b = lower.front(), q = lower.front();
    double nearest = std::numeric_limits<double>::infinity(), cosine = -2;
    for (const Index y : lower) {
      const double squared = squared_from_line(points[y], points[x], direction);
      if (squared < nearest) {
        nearest = squared;
        b = y;
      }
      if (!normals) continue;
      double c = (*normals)(x, 0) * (*normals)(y, 0) + (*normals)(x, 1) * (*normals)(y, 1) +
                 (*normals)(x, 2) * (*normals)(y, 2);
      if (as_lines) c = std::abs(c);
      if (c > 1 - 1e-15) c = 1;  // rounding
      if (c > cosine) {
        cosine = c;
        q = y;
      }
    }
    result.x.push_back(x);
    result.b.push_back(b);
    result.squared.push_back(nearest);
    result.error += normals ? (points[b] - points[q]).squaredNorm() : nearest;
  }
  result.error /= static_cast<double>(upper.size());
  result.clearance = clearance(points, result);
  result.score = std::log(result.clearance + 1) + std::exp(-result.error);
  return result;
}

// Algorithm 3.
inline Trial along_normals(PointsView points, const Points& normals) {
  Trial result;
  for (Index x = 0; x < points.size(); ++x) {
    Index b = -1;
    double nearest = std::numeric_limits<double>::infinity();
    for (Index y = 0; y < points.size(); ++y) {
      if (y == x) continue;
      const double squared = squared_from_line(points[y], points[x], normals.row(x));
      if (squared < nearest) {
        nearest = squared;
        b = y;
      }
    }
    result.x.push_back(x);
    result.b.push_back(b);
    result.squared.push_back(nearest);
  }
  return result;
}

}  // namespace symsurf::oracle
