#pragma once

#include <symsurf/points.h>

#include <algorithm>

namespace symsurf {

/// A surface to second order: x + d - (d . shape d / 2) normal for tangents d.
struct SurfacePoint {
  Vector3 position, normal;
  Matrix3 shape;  ///< the derivative of the unit normal (shape operator), in input units
};

/// The way of light from a source to an eye over a point of a surface.
struct LightPath {
  Vector3 source, eye;

  double length(const Vector3& x) const { return (source - x).norm() + (eye - x).norm(); }

  /// How fast the path gets shorter along the surface: minus the gradient of its length, a number
  /// without unit.
  Vector3 descent(const Vector3& x, const Vector3& normal) const;

  /// The tangent step to where the length is stationary, by Newton's method; not finite where
  /// there is none.
  Vector3 step(const SurfacePoint& at) const;

  /// Whether light is reflected there: the length is stationary, and source and eye lie on the same
  /// side of the tangent plane.
  bool is_reflected(const SurfacePoint& at) const;

  /// At the eye, of a source of unit intensity: reflection_points.h.
  double irradiance(const SurfacePoint& at) const;

 private:
  Eigen::Matrix2d hessian(const SurfacePoint& at, const Eigen::Matrix<double, 3, 2>& basis) const;
};

/// A path is stationary where its length changes by less than this, times the way along the mirror.
inline constexpr double stationary = 1e-10;

/// Newton's steps, none longer than `trust`, from near a point at which light is reflected to that
/// point. `surface(x, at)` gives the surface's point next to x, false where it has none.
template <typename Surface>
bool converges(const LightPath& path, const Surface& surface, Vector3 x, double trust,
               SurfacePoint& at) {
  constexpr int most_steps = 20;
  constexpr double rounding = 1e-14;
  double least = stationary;
  SurfacePoint here;
  for (int k = 0; k < most_steps && surface(x, here); ++k) {
    const double descent = path.descent(here.position, here.normal).norm();
    if (descent <= least) {
      least = descent;
      at = here;
    } else if (least < stationary) {
      break;  // rounding is all that moves
    }
    if (descent <= rounding) break;
    const Vector3 step = path.step(here);
    const double length = step.norm();
    if (!(length < 1e300)) break;
    x = here.position + std::min(1.0, trust / length) * step;
  }
  return least < stationary && path.is_reflected(at);
}

}  // namespace symsurf
