#include <symsurf/context.h>
#include <symsurf/mirrors.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/math.h"
#include "mirrors/mirror_mesh.h"

namespace symsurf {

Cylinder::Cylinder(const Vector3& point, const Vector3& axis, double radius)
    : point_(point), axis_(axis / length_of(axis)), radius_(radius) {
  const double length = length_of(axis);
  if (!point.allFinite() || !(length > 0) || !std::isfinite(length) || !(radius > 0) ||
      !std::isfinite(radius))
    throw InvalidInput(
        "a cylinder needs a finite point, an axis of finite length above 0 and a finite radius "
        "above 0; given " +
        to_string(Value(point)) + ", " + to_string(Value(axis)) + " and " +
        to_string(Value(radius)));
}

Vector3 Cylinder::foot(const Vector3& x) const {
  const Vector3 v = from_axis(x);
  const double distance = v.norm();
  return distance > 0 ? Vector3(x + (radius_ / distance - 1) * v) : no_point();
}

double Cylinder::signed_distance(const Vector3& x) const {
  const double distance = from_axis(x).norm();
  return distance > 0 ? distance - radius_ : std::numeric_limits<double>::quiet_NaN();
}

bool Cylinder::has_image(const Vector3& x) const {
  const double distance = from_axis(x).norm();
  return distance > 0 && distance <= 2 * radius_;
}

Values Cylinder::numbers() const {
  return {{"point", point_}, {"axis", axis_}, {"radius", radius_}};
}

std::unique_ptr<Mirror> Cylinder::transformed(double scale, const Matrix3& rotation,
                                              const Vector3& translation) const {
  return std::make_unique<Cylinder>(scale * (rotation * point_) + translation, rotation * axis_,
                                    scale * radius_);
}

Mesh Cylinder::mesh_over(PointsView object, int resolution, const Context& context) const {
  constexpr double pi = std::numbers::pi;
  std::vector<Vector3> feet;
  Vector3 sum = Vector3::Zero();
  for (Index i = 0; i < object.size(); ++i) {
    if (!has_image(object[i])) continue;
    feet.push_back(foot(object[i]) - point_);
    sum += from_axis(object[i]).normalized();
  }
  if (feet.empty())
    throw InvalidInput("none of the " + std::to_string(object.size()) +
                       " points of the object has an image over this cylinder");
  // Angles are counted from the mean direction, so that the shell's gap falls opposite to it.
  const bool balanced = sum.norm() < 1e-9 * static_cast<double>(feet.size());
  const Vector3 e1 = balanced ? Vector3(axis_.unitOrthogonal()) : Vector3(sum.normalized());
  const Vector3 e2 = axis_.cross(e1);
  double first = pi, last = -pi, low = std::numeric_limits<double>::infinity(), high = -low;
  for (const Vector3& y : feet) {
    const double angle = std::atan2(y.dot(e2), y.dot(e1));
    first = std::min(first, angle);
    last = std::max(last, angle);
    low = std::min(low, y.dot(axis_));
    high = std::max(high, y.dot(axis_));
  }
  const double arc = radius_ * (last - first), height = high - low;
  return grid_mesh(grid_cells(arc, height, resolution), context,
                   [&](double s, double t) -> Vector3 {
                     const double angle = first + s * (last - first);
                     return point_ + (low + t * height) * axis_ +
                            radius_ * (std::cos(angle) * e1 + std::sin(angle) * e2);
                   });
}

}  // namespace symsurf
