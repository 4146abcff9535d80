#pragma once

#include <symsurf/mirror.h>
#include <symsurf/mirrors.h>
#include <symsurf/points.h>

#include <algorithm>
#include <functional>
#include <vector>

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

/// A function of an angle: constant + c1 cos + s1 sin + c2 cos 2 + s2 sin 2.
struct TurnPolynomial {
  double constant, c1, s1, c2, s2;

  /// Its zeros within one turn, in radians: at most four, the roots of a quartic in the tangent of
  /// half the angle. None where it is zero everywhere.
  std::vector<double> zeros() const;
};

/// The points of the unit circle, as unit vectors, at which light is reflected from a source to an
/// eye in its plane (Alhazen's problem): at most four.
///
/// With complex numbers s, e and z on the circle, s / z - 1 and e / z - 1 are where they are seen
/// from z along the normal. Light is reflected where these have opposite angles, so that their
/// product is real and positive: Im(s e / z^2 - (s + e) / z) = 0.
std::vector<Eigen::Vector2d> circle_reflection(const Eigen::Vector2d& source,
                                               const Eigen::Vector2d& eye);

/// The points at which a quadric reflects light to an eye, by a search in one dimension.
///
/// There the surface's normal n lies in one plane with source and eye. That holds on a curve, the
/// intersection of the mirror with a second quadric (Miguel et al.). A plane through source and
/// eye with the normal m holds two points of it: those of the mirror on the line where n . m = 0,
/// which is linear in the point. So the angle of the plane numbers the curve. The law of
/// reflection, with w the tangent in the plane and s and e seen from the point x as unit vectors,
///
///   s . w e . n + e . w s . n = 0,
///
/// is halved until the cubic of its values and slopes rises, falls or stays away from 0. A plane
/// through both ends that mirrors the quadric holds a conic of the curve, which is searched
/// likewise, by the angle of a line through the eye.
class QuadricReflection {
 public:
  QuadricReflection(const Quadric& quadric, const Vector3& eye);

  /// In no order; some twice.
  std::vector<SurfacePoint> operator()(const Vector3& source) const;

 private:
  Vector3 eye_;
  Matrix3 axes_;  // eigenvectors, columns
  // f = y . (curves * y) + linear . y + constant in the frame of the axes about the eye.
  Vector3 curves_, linear_;
  double constant_;
};

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
