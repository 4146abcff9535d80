#pragma once

#include <symsurf/mirror.h>

namespace symsurf {

/// The plane normal . x + offset = 0.
class Plane final : public Mirror {
 public:
  /// The normal may have any length but zero; it and the offset are divided by that length.
  /// Throws InvalidInput for a zero or non-finite normal or a non-finite offset.
  Plane(const Vector3& normal, double offset);

  const Vector3& normal() const { return normal_; }
  double offset() const { return offset_; }
  /// The plane's point closest to the origin of the coordinates.
  Vector3 origin() const { return -offset_ * normal_; }
  /// A right-handed frame, a unit vector a row: two within the plane, then the normal. The first is
  /// orthogonal to the coordinate axis that the normal leans towards least; of equal ones the
  /// first.
  Matrix3 axes() const;

  /// The reflection as a 4 x 4 matrix on homogeneous columns (x, y, z, 1).
  Matrix4 matrix() const;

  std::string_view kind() const override { return "plane"; }
  Vector3 foot(const Vector3& x) const override { return x - signed_distance(x) * normal_; }
  double signed_distance(const Vector3& x) const override { return normal_.dot(x) + offset_; }
  Values numbers() const override;
  std::unique_ptr<Mirror> transformed(double scale, const Matrix3& rotation,
                                      const Vector3& translation) const override;
  using Mirror::signed_distance;

 private:
  Mesh mesh_over(PointsView object, int resolution, const Context& context) const override;

  Vector3 normal_;
  double offset_;
};

}  // namespace symsurf
