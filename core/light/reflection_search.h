#pragma once

#include <symsurf/mirrors.h>
#include <symsurf/points.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <complex>
#include <functional>
#include <optional>
#include <vector>

#include "base/math.h"
#include "operations/operation.h"

namespace symsurf {

/// A surface to second order: x + d - (d . shape d / 2) normal for tangents d.
struct SurfacePoint {
  Vector3 position, normal;
  Matrix3 shape;  ///< the derivative of the unit normal (shape operator), in input units
};

/// A path is stationary where its length changes by less than this, times the way along the mirror.
inline constexpr double stationary = 1e-10;

/// The way of light from a source to an eye over a point of a surface.
struct LightPath {
  Vector3 source, eye;

  double length(const Vector3& x) const { return (source - x).norm() + (eye - x).norm(); }

  /// How fast the path gets shorter along the surface: minus the gradient of its length, a number
  /// without unit.
  Vector3 descent(const Vector3& x, const Vector3& normal) const {
    const Vector3 sum = (source - x).normalized() + (eye - x).normalized();
    return sum - sum.dot(normal) * normal;
  }

  /// Of the length of x + d - (d . shape d / 2) n by the tangent d: that of each part in space,
  /// (I - u u') / |.|, and the curvature's, as the length falls by u + v towards n.
  Eigen::Matrix2d hessian(const SurfacePoint& at, const Eigen::Matrix<double, 3, 2>& basis) const {
    Eigen::Matrix2d sum = Eigen::Matrix2d::Zero();
    double towards = 0;
    for (const Vector3& end : {source, eye}) {
      const Vector3 way = end - at.position;
      const double distance = way.norm();
      const Eigen::Vector2d along = basis.transpose() * way / distance;
      sum += (Eigen::Matrix2d::Identity() - along * along.transpose()) / distance;
      towards += way.dot(at.normal) / distance;
    }
    return sum + towards * (basis.transpose() * at.shape * basis);
  }

  /// The tangent step to where the length is stationary, by Newton's method; not finite where
  /// there is none.
  Vector3 step(const SurfacePoint& at) const {
    const auto basis = orthogonal_to(at.normal);
    const Vector3 way = descent(at.position, at.normal);
    return basis * (hessian(at, basis).inverse() * (basis.transpose() * way));
  }

  /// Whether light is reflected there: the length is stationary, and source and eye lie on the same
  /// side of the tangent plane.
  bool is_reflected(const SurfacePoint& at) const {
    const double sides = (source - at.position).normalized().dot(at.normal) *
                         (eye - at.position).normalized().dot(at.normal);
    constexpr double grazing = 1e-16;  // the square of the sine of the angle with the surface
    return sides > grazing && descent(at.position, at.normal).norm() <= stationary;
  }

  /// At the eye, of a source of unit intensity: ReflectionPoints.
  double irradiance(const SurfacePoint& at) const {
    const double to_source = (source - at.position).norm(), to_eye = (eye - at.position).norm();
    const double cosine = (source - at.position).dot(at.normal) / to_source;
    const double ratio = cosine / (to_source * to_eye);
    return ratio * ratio / std::abs(hessian(at, orthogonal_to(at.normal)).determinant());
  }
};

/// Newton's steps, none longer than `trust`, from near a point at which light is reflected to that
/// point. `surface(x)` is the surface's point next to x, if it has one.
template <typename Surface>
std::optional<SurfacePoint> converged(const LightPath& path, const Surface& surface, Vector3 x,
                                      double trust) {
  constexpr int most_steps = 20;
  constexpr double rounding = 1e-14;
  double least = stationary;
  std::optional<SurfacePoint> best;
  for (int k = 0; k < most_steps; ++k) {
    const std::optional<SurfacePoint> here = surface(x);
    if (!here) break;
    const double descent = path.descent(here->position, here->normal).norm();
    if (descent <= least) {
      least = descent;
      best = here;
    } else if (best) {
      break;  // rounding is all that moves
    }
    if (descent <= rounding) break;
    const Vector3 step = path.step(*here);
    const double length = step.norm();
    if (!(length < 1e300)) break;
    x = here->position + std::min(1.0, trust / length) * step;
  }
  if (best && !path.is_reflected(*best)) best.reset();
  return best;
}

/// A function of an angle t: constant + Re(one exp(-i t) + two exp(-2 i t)).
struct TurnPolynomial {
  double constant;
  std::complex<double> one, two;

  /// Its zeros within one turn, in radians: at most four, the roots of a quartic in the tangent of
  /// half the angle. None where it is zero everywhere.
  std::vector<double> zeros() const;
};

/// Finds the points at which a mirror reflects light, in no order; some twice.
using ReflectionFinder = std::function<std::vector<SurfacePoint>(const LightPath&)>;

/// Finds those of a quadric for paths to the eye, by a search in one dimension.
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
ReflectionFinder quadric_reflection(const Quadric& quadric, const Vector3& eye);

OperationImplementation illuminate_operation();

}  // namespace symsurf
