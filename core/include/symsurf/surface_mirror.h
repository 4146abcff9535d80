#pragma once

#include <symsurf/mirror.h>
#include <symsurf/surface.h>

namespace symsurf {

/// Which way a point is mirrored over a surface.
enum class Mapping { Fixed, Perpendicular };

/// The graph of a known surface as a mirror: the truth of generated samples. In the surface's own
/// frame it is z = f(x, y); `transformed` positions it elsewhere.
class SurfaceMirror final : public Mirror {
 public:
  SurfaceMirror(const Surface& surface, Mapping mapping);
  /// Placed: x -> scale * rotation * x + translation from its own frame.
  /// Throws InvalidInput unless scale > 0 and rotation is orthonormal.
  SurfaceMirror(const Surface& surface, Mapping mapping, double scale, const Matrix3& rotation,
                const Vector3& translation);

  const Surface& surface() const { return surface_; }
  Mapping mapping() const { return mapping_; }
  /// The direction of mapping of a fixed one: the surface's z axis where it stands.
  Vector3 direction() const { return rotation_.col(2); }

  /// The point of the graph closest to x, whatever the mapping: the nearest minimum to the best of
  /// a grid of starts, to rounding.
  Vector3 closest(const Vector3& x) const { return position(closest_in_frame(to_frame(x))); }

  /// x in the surface's frame, where the surface is z = f(x, y).
  Vector3 to_frame(const Vector3& x) const {
    return rotation_.transpose() * (x - translation_) / scale_;
  }
  /// Input units a unit of that frame.
  double scale() const { return scale_; }

  std::string_view kind() const override { return "surface"; }
  Vector3 foot(const Vector3& x) const override;
  double signed_distance(const Vector3& x) const override;
  /// "surface", "mapping", "scale", "rotation" (3 x 3) and "translation".
  Values numbers() const override;
  std::unique_ptr<Mirror> transformed(double scale, const Matrix3& rotation,
                                      const Vector3& translation) const override;
  using Mirror::signed_distance;

 private:
  Mesh mesh_over(PointsView object, int resolution, const Context& context) const override;
  Vector3 foot_in_frame(const Vector3& x) const;
  Vector3 closest_in_frame(const Vector3& x) const;
  Vector3 position(const Vector3& x) const { return scale_ * (rotation_ * x) + translation_; }

  const Surface& surface_;
  Mapping mapping_;
  double scale_ = 1;
  Matrix3 rotation_ = Matrix3::Identity();
  Vector3 translation_ = Vector3::Zero();
};

}  // namespace symsurf
