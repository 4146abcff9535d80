#pragma once

#include <symsurf/mirror.h>

#include <memory>
#include <vector>

namespace symsurf {

/// A quadratic piece of a surface: height z over the tangent coordinates (s, t) of its frame,
/// z = h0 + h1 s + h2 t + h3 s^2 + h4 s t + h5 t^2.
struct Patch {
  using Heights = Eigen::Matrix<double, 6, 1>;

  Vector3 centre;     ///< origin of the frame, on or near the surface
  Matrix3 frame;      ///< rows: two tangents and the normal, orthonormal
  Heights height;     ///< h0 .. h5
  double radius = 0;  ///< how far from the centre the piece has a say
};

/// A smooth surface of any shape, mirrored perpendicularly: the zero set of the blend of quadratic
/// patches with weights (1 - |x - centre|^2 / radius^2)^3 (a partition of unity: Ohtake et al.
/// 2003, "Multi-level partition of unity implicits"). Neighbouring patches must overlap and agree
/// about the side their normals point to. Points whose foot lies beyond the patches have none.
class FreeForm final : public Mirror {
 public:
  /// Throws InvalidInput without patches, for non-finite numbers, a radius that is not above 0 or a
  /// frame that is not orthonormal.
  explicit FreeForm(std::vector<Patch> patches);

  const std::vector<Patch>& patches() const;

  std::string_view kind() const override { return "free-form"; }
  Vector3 foot(const Vector3& x) const override;
  double signed_distance(const Vector3& x) const override;
  /// "centres", "tangents", "normals" (k x 3 each), "heights" (k x 6) and "radii" (k x 1).
  Values numbers() const override;
  std::unique_ptr<Mirror> transformed(double scale, const Matrix3& rotation,
                                      const Vector3& translation) const override;
  using Mirror::signed_distance;

  /// The foot of x and the mirror's unit normal there, to a precision relative to the patches'
  /// size; false where x has no foot.
  bool foot(const Vector3& x, double precision, Vector3& foot, Vector3& normal) const;

 private:
  struct Blend;

  Mesh mesh_over(PointsView object, int resolution, const Context& context) const override;

  std::shared_ptr<const Blend> blend_;
};

}  // namespace symsurf
