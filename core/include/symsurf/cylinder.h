#pragma once

#include <symsurf/mirror.h>

namespace symsurf {

/// The circular cylinder |(x - point) - ((x - point) . axis) axis| = radius. A point is mirrored
/// along the radius, so points on the axis and points farther than 2r from it have no image.
class Cylinder final : public Mirror {
 public:
  /// The axis may have any length but zero; it is divided by that length.
  /// Throws InvalidInput for a non-finite point or axis, a zero axis or a radius that is not finite
  /// and above 0.
  Cylinder(const Vector3& point, const Vector3& axis, double radius);

  const Vector3& point() const { return point_; }
  const Vector3& axis() const { return axis_; }
  double radius() const { return radius_; }

  std::string_view kind() const override { return "cylinder"; }
  Vector3 foot(const Vector3& x) const override;
  /// Positive outside; NaN on the axis.
  double signed_distance(const Vector3& x) const override;
  Values numbers() const override;
  std::unique_ptr<Mirror> transformed(double scale, const Matrix3& rotation,
                                      const Vector3& translation) const override;
  using Mirror::signed_distance;

 private:
  bool has_image(const Vector3& x) const override;
  /// The shell over the angles and heights of the points that have an image.
  Mesh mesh_over(PointsView object, int resolution, const Context& context) const override;
  Vector3 from_axis(const Vector3& x) const {
    const Vector3 d = x - point_;
    return d - d.dot(axis_) * axis_;
  }

  Vector3 point_, axis_;
  double radius_;
};

}  // namespace symsurf
