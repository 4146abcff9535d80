#pragma once

#include <symsurf/mirror.h>

namespace symsurf {

/// The sphere |x - centre| = radius. A point is mirrored along the radius, |x' - c| = 2r - |x - c|
/// (not inversion), so the centre and points farther than 2r from it have no image.
class Sphere final : public Mirror {
 public:
  /// Throws InvalidInput for a non-finite centre or a radius that is not finite and above 0.
  Sphere(const Vector3& centre, double radius);

  const Vector3& centre() const { return centre_; }
  double radius() const { return radius_; }

  std::string_view kind() const override { return "sphere"; }
  Vector3 foot(const Vector3& x) const override;
  /// Positive outside; NaN at the centre.
  double signed_distance(const Vector3& x) const override;
  Values numbers() const override;
  std::unique_ptr<Mirror> transformed(double scale, const Matrix3& rotation,
                                      const Vector3& translation) const override;
  using Mirror::signed_distance;

 private:
  bool has_image(const Vector3& x) const override;
  /// The cap about the mean direction of the points that have an image.
  Mesh mesh_over(PointsView object, int resolution, const Context& context) const override;

  Vector3 centre_;
  double radius_;
};

}  // namespace symsurf
