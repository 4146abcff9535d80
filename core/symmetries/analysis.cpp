#include "analysis.h"

#include <symsurf/analyses.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include "cloud/cloud.h"

namespace symsurf {

Vector3 Transformation::place(PointsView points) const {
  Vector3 sum = Vector3::Zero();
  Index count = 0;
  const auto add = [&](const Vector3& x) {
    if (!x.allFinite()) return;
    sum += x;
    ++count;
  };
  for (const Index i : from) add(points[i]);
  if (from.empty())
    for (Index i = 0; i < points.size(); ++i) add(points[i]);
  if (count == 0) throw InvalidInput("none of the points that are mapped is finite");
  return (matrix * (sum / static_cast<double>(count)).homogeneous()).head<3>();
}

std::array<Vector3, 2> SymmetryAxis::segment(PointsView points) const {
  constexpr double beyond = 0.1;  // of the extent along the axis, at each end
  require_points(points);
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (Index i = 0; i < points.size(); ++i) {
    const double along = direction.dot(points[i] - point);
    low = std::min(low, along);
    high = std::max(high, along);
  }
  const double margin = beyond * (high - low);
  return {point + (low - margin) * direction, point + (high + margin) * direction};
}

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

void require_colours(PointsView points, const Eigen::MatrixXd& colours) {
  if (colours.size() == 0) return;
  if (colours.rows() != points.size())
    throw InvalidInput(std::to_string(colours.rows()) + " colours are given for " +
                       std::to_string(points.size()) + " points; allowed is one per point");
  for (Index i = 0; i < points.size(); ++i)
    if (points[i].allFinite() && !colours.row(i).allFinite())
      throw InvalidInput("the colour of point " + std::to_string(i) + " is not finite");
}

}  // namespace symsurf
