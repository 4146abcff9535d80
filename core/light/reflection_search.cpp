#include "reflection_search.h"

#include <cmath>

#include "base/math.h"

namespace symsurf {

Vector3 LightPath::descent(const Vector3& x, const Vector3& normal) const {
  const Vector3 sum = (source - x).normalized() + (eye - x).normalized();
  return sum - sum.dot(normal) * normal;
}

// Of the length of x + d - (d . shape d / 2) n by d: that of each part in space, (I - u u') / |.|,
// and the curvature's, as the length falls by u + v towards n.
Eigen::Matrix2d LightPath::hessian(const SurfacePoint& at,
                                   const Eigen::Matrix<double, 3, 2>& basis) const {
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

Vector3 LightPath::step(const SurfacePoint& at) const {
  const auto basis = orthogonal_to(at.normal);
  const Eigen::Matrix2d h = hessian(at, basis);
  const Eigen::Vector2d w = basis.transpose() * descent(at.position, at.normal);
  const Eigen::Vector2d solved(h(1, 1) * w[0] - h(0, 1) * w[1], h(0, 0) * w[1] - h(1, 0) * w[0]);
  return basis * solved / (h(0, 0) * h(1, 1) - h(0, 1) * h(1, 0));
}

bool LightPath::is_reflected(const SurfacePoint& at) const {
  const double sides = (source - at.position).normalized().dot(at.normal) *
                       (eye - at.position).normalized().dot(at.normal);
  constexpr double grazing = 1e-16;  // the square of the sine of the angle with the surface
  return sides > grazing && descent(at.position, at.normal).norm() <= stationary;
}

double LightPath::irradiance(const SurfacePoint& at) const {
  const double to_source = (source - at.position).norm(), to_eye = (eye - at.position).norm();
  const double cosine = (source - at.position).dot(at.normal) / to_source;
  const Eigen::Matrix2d h = hessian(at, orthogonal_to(at.normal));
  const double determinant = h(0, 0) * h(1, 1) - h(0, 1) * h(1, 0);
  const double ratio = cosine / (to_source * to_eye);
  return ratio * ratio / std::abs(determinant);
}

}  // namespace symsurf
