#pragma once

#include <symsurf/mirrors.h>
#include <symsurf/points.h>

#include <Eigen/Core>
#include <Eigen/Dense>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "base/math.h"
#include "cloud/principal_frame.h"

namespace symsurf {

/// Unit vectors across one.
inline Vector3 across(const Vector3& unit, int k) {
  const Vector3 first = unit.unitOrthogonal();
  return k == 0 ? first : unit.cross(first);
}

/// The matrix of v x.
inline Matrix3 cross_matrix(const Vector3& v) {
  Matrix3 m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

/// The rotation about a vector by its length, radians.
inline Matrix3 turn_by(const Vector3& turn) {
  const double angle = turn.norm();
  if (!(angle > 0)) return Matrix3::Identity();
  return Eigen::AngleAxisd(angle, turn / angle).toRotationMatrix();
}

/// A circular cylinder while it is searched for, in the principal frame; |axis| = 1.
struct UnitCylinder {
  /// What is added to the point and to the axis, along either side each, and to the radius.
  using Change = Eigen::Vector<double, 5>;

  Vector3 point = Vector3::Zero();
  Vector3 axis = Vector3::UnitZ();
  double radius = 1;

  Vector3 from_axis(const Vector3& x) const {
    const Vector3 d = x - point;
    return d - d.dot(axis) * axis;
  }
  double distance(const Vector3& x) const { return from_axis(x).norm() - radius; }

  /// NaN where x has no image.
  Vector3 reflect(const Vector3& x) const {
    const Vector3 v = from_axis(x);
    const double length = v.norm();
    if (!(length > double_rounding) || length > 2 * radius)
      return Vector3::Constant(std::numeric_limits<double>::quiet_NaN());
    return x + 2 * (radius / length - 1) * v;
  }

  /// The unit normal at the image of a surface through x with normal n: tangents around the axis
  /// stretch by 2r / |v| - 1, normals by its inverse.
  Vector3 reflect_direction(const Vector3& x, const Vector3& n) const {
    const Vector3 v = from_axis(x);
    const double length = v.norm();
    const Vector3 u = v / length;
    const double stretch = std::max(2 * radius / length - 1, 1e-6);
    const Vector3 upright = u.dot(n) * u, lengthwise = axis.dot(n) * axis;
    return ((n - upright - lengthwise) / stretch + lengthwise - upright).normalized();
  }

  /// Of the axis.
  Vector3 nearest_to_origin() const { return point - point.dot(axis) * axis; }

  /// By how much each number moves the image of x: x' = x - 2 (1 - r / |v|) v, v = (I - a a') (x -
  /// p).
  Eigen::Matrix<double, 3, 5> slopes(const Vector3& x) const {
    const Vector3 d = x - nearest_to_origin(), v = from_axis(x);
    const double length = v.norm(), bend = radius / length;
    const Vector3 u = v / length;
    const Matrix3 by_v = -2 * ((1 - bend) * Matrix3::Identity() + bend * u * u.transpose());
    Eigen::Matrix<double, 3, 5> slopes;
    for (int k = 0; k < 2; ++k) {
      const Vector3 s = side(k);
      slopes.col(k) = by_v * -s;
      slopes.col(2 + k) = by_v * (-d.dot(s) * axis - d.dot(axis) * s);
    }
    slopes.col(4) = 2 * u;
    return slopes;
  }

  /// Changed by no more than keeps it from turning inside out, and by how much.
  std::pair<UnitCylinder, double> stepped(const Change& by) const {
    const double length = by.norm(), longest = std::min(0.5 * radius, 1.0);
    return {changed(length > longest ? Change(longest / length * by) : by),
            std::min(length, longest)};
  }

  /// The axis tilts about its point nearest to the origin.
  void follow(const UnitCylinder& moved) { *this = moved; }
  static constexpr double ridge = 1e-13;  // rounding
  static constexpr bool is_affine = false;

  UnitCylinder changed(const Change& by) const {
    return {nearest_to_origin() + by[0] * side(0) + by[1] * side(1),
            (axis + by[2] * side(0) + by[3] * side(1)).normalized(),
            std::max(radius + by[4], 1e-3)};
  }

  Vector3 side(int k) const { return across(axis, k); }
};

/// A plane with a direction of its own while it is searched for, in the principal frame: |normal| =
/// 1, normal . direction = 1.
struct UnitObliquePlane {
  /// Two tilts of the normal, along unit vectors across it, what is added to the offset, and to the
  /// direction along the same vectors.
  using Change = Eigen::Vector<double, 5>;

  Vector3 normal = Vector3::UnitX();
  double offset = 0;
  Vector3 direction = Vector3::UnitX();

  double height(const Vector3& x) const { return normal.dot(x) + offset; }
  double distance(const Vector3& x) const { return height(x) * direction.norm(); }
  Vector3 reflect(const Vector3& x) const { return x - 2 * height(x) * direction; }
  Vector3 reflect_direction(const Vector3& /*x*/, const Vector3& n) const {
    return (n - 2 * direction.dot(n) * normal).normalized();
  }

  /// By how much each number moves the image of x.
  Eigen::Matrix<double, 3, 5> slopes(const Vector3& x) const {
    Eigen::Matrix<double, 3, 5> slopes;
    for (int k = 0; k < 2; ++k) {
      const Vector3 s = side(k);
      slopes.col(k) = -2 * (s.dot(x) - height(x) * s.dot(direction)) * direction;
      slopes.col(3 + k) = -2 * height(x) * s;
    }
    slopes.col(2) = -2 * direction;
    return slopes;
  }

  /// Changed, and by how much.
  std::pair<UnitObliquePlane, double> stepped(const Change& by) const {
    const Vector3 tilted = normal + by[0] * side(0) + by[1] * side(1);
    const Vector3 turned = direction + by[3] * side(0) + by[4] * side(1);
    const double length = tilted.norm();
    return {{tilted / length, (offset + by[2]) / length, length / tilted.dot(turned) * turned},
            by.norm()};
  }
  void follow(const UnitObliquePlane& moved) { *this = moved; }
  static constexpr double ridge = 1e-13;  // rounding
  static constexpr bool is_affine = true;

  Vector3 side(int k) const { return across(normal, k); }
};

/// A reflection and rigid placement of one shape on another while it is searched for: from the
/// principal frame of one into that of the other, in one unit.
struct UnitPlacement {
  /// A small turn about the origin, then a shift.
  using Change = Eigen::Vector<double, 6>;

  Eigen::Isometry3d map = Eigen::Isometry3d::Identity();

  /// Whatever point: it is a mirror to none of them.
  double distance(const Vector3& /*x*/) const { return infinity; }
  Vector3 reflect(const Vector3& x) const { return map * x; }
  Vector3 reflect_direction(const Vector3& /*x*/, const Vector3& n) const {
    return map.linear() * n;
  }

  /// By how much each number moves the image of x.
  Eigen::Matrix<double, 3, 6> slopes(const Vector3& x) const {
    Eigen::Matrix<double, 3, 6> slopes;
    slopes << -cross_matrix(map * x), Matrix3::Identity();
    return slopes;
  }

  /// Changed by no more than a small turn, and by how much.
  std::pair<UnitPlacement, double> stepped(const Change& by) const {
    constexpr double longest = 0.2;  // radians, diagonals
    const double length = by.norm();
    const Change cut = length > longest ? Change(longest / length * by) : by;
    const Eigen::Isometry3d turn(turn_by(cut.head<3>()));
    return {{Eigen::Translation3d(cut.tail<3>()) * turn * map}, std::min(length, longest)};
  }
  void follow(const UnitPlacement& moved) { *this = moved; }
  static constexpr double ridge = 1e-5;  // directions that slide stay as they are
  static constexpr bool is_affine = true;
};

/// A sphere, or where its curvature is 0 a plane, while it is searched for, in the principal frame:
/// F(x) = k/2 |x - p|^2 + n . (x - p) = 0 through the point p with the unit normal n there. The
/// sign of k is the side it bends to (Pratt, Direct least-squares fitting of algebraic surfaces,
/// 1987).
struct UnitSphere {
  /// A shift along the normal, two tilts about the point, what is added to the curvature.
  using Change = Eigen::Vector4d;

  Vector3 point = Vector3::Zero(), normal = Vector3::UnitX();
  double curvature = 1;

  /// Neither is finite of a plane.
  double radius() const { return 1 / std::abs(curvature); }
  Vector3 centre() const { return point - normal / curvature; }

  /// Its length at x is the distance from the centre, in radii: 1 on the mirror.
  Vector3 gradient(const Vector3& x) const { return normal + curvature * (x - point); }

  double distance(const Vector3& x) const { return twice_distance(x, gradient(x).norm()) / 2; }

  /// NaN where x has no image.
  Vector3 reflect(const Vector3& x) const {
    const Vector3 up = gradient(x);
    const double length = up.norm();
    if (!(length > double_rounding) || length > 2)
      return Vector3::Constant(std::numeric_limits<double>::quiet_NaN());
    return x - twice_distance(x, length) / length * up;
  }

  /// The unit normal at the image of a surface through x with normal v: tangents across the radius
  /// stretch by 2 / |gradient| - 1, normals by its inverse.
  Vector3 reflect_direction(const Vector3& x, const Vector3& v) const {
    const Vector3 up = gradient(x);
    const double length = up.norm(), stretch = std::max(2 / length - 1, 1e-6);
    const Vector3 u = up / length;
    const double along = u.dot(v);
    return ((v - along * u) / stretch - along * u).normalized();
  }

  /// By how much each number moves the image x' = 2 q - x, q the mirror's point nearest to x, d
  /// away, u the direction and g the length of the gradient at x: a change of F by f moves it by
  /// -2 (f(q) u + d / g (I - u u') grad f(q)).
  Eigen::Matrix<double, 3, 4> slopes(const Vector3& x) const {
    const Vector3 up = gradient(x);
    const double g = up.norm(), d = twice_distance(x, g) / 2;
    const Vector3 u = up / g, y = x - d * u - point;
    const auto moved = [&](double f, const Vector3& rise) -> Vector3 {
      return -2 * ((f - d / g * u.dot(rise)) * u + d / g * rise);
    };
    Eigen::Matrix<double, 3, 4> slopes;
    slopes << moved(-1 - curvature * normal.dot(y), -curvature * normal),
        moved(side(0).dot(y), side(0)), moved(side(1).dot(y), side(1)),
        moved(y.squaredNorm() / 2, y);
    return slopes;
  }

  /// Changed by no more than half its size, and by how much: flat spheres may bend to the other
  /// side, small ones do not turn inside out.
  std::pair<UnitSphere, double> stepped(const Change& by) const {
    const double size = 1 / std::max(std::abs(curvature), 1.0), longest = 0.5 * size;
    const double length =
        Eigen::Vector4d(by[0], size * by[1], size * by[2], size * size * by[3]).norm();
    return {changed(length > longest ? Change(longest / length * by) : by),
            std::min(length, longest)};
  }

  void follow(const UnitSphere& moved) { *this = moved; }
  static constexpr double ridge = 1e-13;  // rounding
  static constexpr bool is_affine = false;

  UnitSphere changed(const Change& by) const {
    return {point + by[0] * normal, (normal + by[1] * side(0) + by[2] * side(1)).normalized(),
            curvature + by[3]};
  }

  /// Unit vectors across the normal.
  Vector3 side(int k) const {
    const Vector3 first = normal.unitOrthogonal();
    return k == 0 ? first : normal.cross(first);
  }

 private:
  // 4 F / (1 + |gradient|), which loses no digits where the curvature vanishes.
  double twice_distance(const Vector3& x, double length) const {
    const Vector3 off = x - point;
    return 4 * (curvature / 2 * off.squaredNorm() + normal.dot(off)) / (1 + length);
  }
};

inline Sphere in_input_units(const UnitSphere& sphere, const PrincipalFrame& frame) {
  return {frame.from_frame(sphere.centre()), frame.size * sphere.radius()};
}

inline ObliquePlane in_input_units(const UnitObliquePlane& plane, const PrincipalFrame& frame) {
  const Vector3 normal = frame.axes * plane.normal;
  return {normal, frame.size * plane.offset - normal.dot(frame.centroid),
          frame.axes * plane.direction};
}

inline Cylinder in_input_units(const UnitCylinder& cylinder, const PrincipalFrame& frame) {
  return {frame.from_frame(cylinder.point), frame.axes * cylinder.axis,
          frame.size * cylinder.radius};
}

/// How a mirror next to a plane bends, in the principal frame: to the second order its height over
/// the plane through the point is e' C e / 2, e the offset along the plane.
struct PlaneBend {
  Vector3 point, normal;
  Vector3 most_bent;               ///< the principal direction of the greater curvature
  double greater = 0, lesser = 0;  ///< principal curvatures, by amount; to the normal's side

  UnitSphere sphere() const { return {point, normal, -(greater + lesser) / 2}; }
  UnitCylinder cylinder() const {
    return {point + normal / greater, normal.cross(most_bent), 1 / std::abs(greater)};
  }
};

/// A quadric while it is searched for: q . (x^2, y^2, z^2, xy, yz, zx, x, y, z, 1) = 0, |q| = 1.
struct GeneralQuadric {
  using Change = Eigen::Vector<double, 10>;

  explicit GeneralQuadric(const Change& q);

  /// f = 0 and grad f = n at points with normals, by least squares: linear in the coefficients.
  /// None of fewer than ten.
  static std::optional<GeneralQuadric> nearest_to(
      const std::vector<std::pair<Vector3, Vector3>>& points);

  Vector3 reflect(const Vector3& x) const { return 2 * quadric.foot(x) - x; }

  /// By how much each coefficient moves the image of x, from the conditions of the closest point,
  /// y - x + l g(y) = 0 and f(y) = 0.
  Eigen::Matrix<double, 3, 10> slopes(const Vector3& x) const;

  std::pair<GeneralQuadric, double> stepped(const Change& by) const {
    if (!by.allFinite()) return {*this, 0};
    return {GeneralQuadric(coefficients + by), by.norm()};
  }
  void follow(const GeneralQuadric& moved) { *this = moved; }
  static constexpr double ridge = double_rounding;  // the length of the coefficients moves nothing

  Change coefficients;
  Quadric quadric;
};

}  // namespace symsurf
