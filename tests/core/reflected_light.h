#pragma once

#include <gtest/gtest.h>
#include <symsurf/mirrors.h>

#include <string>

#include "random_cloud.h"

namespace symsurf {

constexpr double stationary_to = 1e-10;  // of the path: what the issue asks for

inline ReflectionPoints points_of(const Mirror& mirror, const Vector3& source, const Vector3& eye) {
  return reflection_points(mirror, PointsView(source.data(), 1), eye);
}

inline Vector3 position(const ReflectionPoints& points, Index i) {
  return points.positions.row(i).transpose();
}

inline bool has(const ReflectionPoints& points, const Vector3& x, double within) {
  for (Index i = 0; i < points.positions.rows(); ++i)
    if ((position(points, i) - x).norm() <= within) return true;
  return false;
}

// Light that comes from the source leaves for the eye by the law of reflection; the path changes by
// no more than `stationary_to` along the mirror.
inline void expect_reflected(const Vector3& x, const Vector3& normal, const Vector3& source,
                             const Vector3& eye, const std::string& what) {
  const Vector3 u = (source - x).normalized(), v = (eye - x).normalized();
  EXPECT_LE((u + v).cross(normal).norm(), stationary_to) << what;
  EXPECT_GT(u.dot(normal) * v.dot(normal), 0) << what;
}

/// Of one of ten kinds, moved at random.
inline Quadric random_quadric(RandomCloud& random, int kind) {
  const auto at_least = [&] { return random.uniform(0.3, 2); };
  const double a = at_least(), b = at_least(), c = at_least();
  Vector3 curves, linear = Vector3::Zero();
  double constant = -1;
  switch (kind) {
    case 0:
      curves = {a, b, c};
      break;  // ellipsoid
    case 1:
      curves = {a, b, -c};
      break;  // hyperboloid of one sheet
    case 2:
      curves = {a, -b, -c};
      constant = -0.1;
      break;  // of two
    case 3:
      curves = {a, b, 0};
      linear.z() = -1;
      constant = 0;
      break;  // paraboloid
    case 4:
      curves = {a, -b, 0};
      linear.z() = -1;
      constant = 0;
      break;  // saddle
    case 5:
      curves = {a, b, 0};
      break;  // elliptic cylinder
    case 6:
      curves = {a, a, c};
      break;  // of revolution
    case 7:
      curves = {a, 0, 0};
      linear.z() = -1;
      constant = 0;
      break;  // parabolic cylinder
    case 8:
      curves = {a, -b, 0};
      break;  // hyperbolic cylinder
    default:
      curves = {a, a, 0};
      linear.z() = -1;
      constant = 0;
      break;
  }
  const Matrix3 rotation = random.rotation();
  const Vector3 shift = 0.3 * random.in_box();
  const Quadric quadric(curves.asDiagonal().toDenseMatrix(), linear, constant);
  const auto moved = quadric.transformed(1, rotation, shift);
  return dynamic_cast<const Quadric&>(*moved);
}

}  // namespace symsurf
