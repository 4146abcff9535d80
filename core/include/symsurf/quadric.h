#pragma once

#include <symsurf/mirror.h>

namespace symsurf {

/// The quadric f(x) = x' A x + b . x + c = 0, mirrored perpendicularly over its closest point.
class Quadric final : public Mirror {
 public:
  /// A is made symmetric. Throws InvalidInput for numbers that are not finite, or when A and b are
  /// zero.
  Quadric(const Matrix3& matrix, const Vector3& linear, double constant);
  /// The same about a point: f(x) = (x - o)' A (x - o) + g . (x - o) + f(o), g the gradient there.
  /// Near the object it keeps the digits that b and c lose far from the coordinates' own origin.
  Quadric(const Matrix3& matrix, const Vector3& origin, const Vector3& gradient, double value);

  const Matrix3& matrix() const { return matrix_; }
  Vector3 linear() const { return linear_ - 2 * (matrix_ * origin_); }
  double constant() const { return value(Vector3::Zero()); }

  double value(const Vector3& x) const {
    const Vector3 d = x - origin_;
    return d.dot(matrix_ * d) + linear_.dot(d) + constant_;
  }
  Vector3 gradient(const Vector3& x) const { return 2 * (matrix_ * (x - origin_)) + linear_; }

  std::string_view kind() const override { return "quadric"; }
  /// The closest point: y = (I + 2 l A)^-1 (x - l b) for the one l with f(y) = 0 between the poles
  /// on either side of 0. NaN where there is none: on the inner focal set, or without real points.
  Vector3 foot(const Vector3& x) const override;
  /// Positive where f is.
  double signed_distance(const Vector3& x) const override;
  /// "matrix" (3 x 3), "linear", "constant"; about a point near the object "origin", "gradient" and
  /// "value". One made from numbers with the latter is made from those.
  Values numbers() const override;
  std::unique_ptr<Mirror> transformed(double scale, const Matrix3& rotation,
                                      const Vector3& translation) const override;
  using Mirror::signed_distance;

 private:
  Mesh mesh_over(PointsView object, int resolution, const Context& context) const override;

  // Far from the coordinates' own origin the terms cancel.
  Vector3 origin_ = Vector3::Zero();
  Matrix3 matrix_;
  Vector3 linear_;
  double constant_;
  Matrix3 axes_;    // eigenvectors of A
  Vector3 curves_;  // its eigenvalues
};

}  // namespace symsurf
