#pragma once

#include <symsurf/mirror.h>

#include <functional>
#include <vector>

#include "optics/light_path.h"

namespace symsurf {

/// The points at which a mirror without a formula reflects light to an eye: Newton's steps from the
/// triangles of a mesh over its footprint on which the path length, whose gradient is interpolated,
/// is stationary or nearly so.
class FootprintReflection {
 public:
  /// Height fields, free forms and surface mirrors. Throws InvalidInput where there is no
  /// footprint, nor nodes or patches to stand for it.
  FootprintReflection(const Mirror& mirror, const Vector3& eye);

  /// In no order; some twice.
  std::vector<SurfacePoint> operator()(const Vector3& source) const;

 private:
  // The foot of x, or the surface's point over x, and the normal there.
  using Tangent = std::function<bool(const Vector3& x, Vector3& foot, Vector3& normal)>;

  static Tangent tangent_of(const Mirror& mirror);
  bool at(const Vector3& x, SurfacePoint& found) const;

  Vector3 eye_;
  Tangent tangent_;
  std::vector<Vector3> feet_, normals_;  // of the mesh's vertices
  Triangles triangles_;
  double step_;  // over which normals are compared
};

}  // namespace symsurf
