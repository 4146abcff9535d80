#include "symmetries/transformation_kind.h"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

namespace symsurf {

std::string kind_of(const Matrix4& matrix, const Vector3& centre, double angle_tolerance,
                    double length_tolerance) {
  const Matrix3 linear = matrix.topLeftCorner<3, 3>();
  const Vector3 shift = linear * centre + matrix.topRightCorner<3, 1>() - centre;
  const double scale = std::cbrt(linear.determinant());
  if (std::abs(std::abs(scale) - 1) > angle_tolerance) return "similarity";
  // x -> turn x or -turn x, and the shift.
  const Eigen::AngleAxisd turn(Matrix3(linear / scale));
  const auto is_turned_by = [&](double angle) {
    return std::abs(turn.angle() - angle) <= angle_tolerance;
  };
  const Vector3& axis = turn.axis();
  const auto is_short = [&](const Vector3& v) { return v.norm() <= length_tolerance; };
  if (scale > 0) {
    if (is_turned_by(0)) return is_short(shift) ? "identity" : "translation";
    return is_short(shift.dot(axis) * axis) ? "rotation" : "screw";
  }
  if (is_turned_by(0)) return "inversion";
  if (!is_turned_by(std::numbers::pi)) return "rotary reflection";
  return is_short(shift - shift.dot(axis) * axis) ? "reflection" : "glide reflection";
}

}  // namespace symsurf
