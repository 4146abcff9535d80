#include "bumpy_object.h"

#include <Eigen/Geometry>
#include <cmath>
#include <random>

namespace symsurf::benchmarks {

Points bumpy_object(Index count, unsigned seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  const Matrix3 rotation =
      Eigen::Quaterniond(normal(random), normal(random), normal(random), normal(random))
          .normalized()
          .toRotationMatrix();
  Points points(count, 3);
  Vector3 x = Vector3::Zero();
  for (Index i = 0; i < count; ++i) {
    if (i % 2 == 0) {
      const Vector3 u = Vector3(normal(random), normal(random), normal(random)).normalized();
      const double radius = 1 + 0.3 * std::sin(3 * u.y() + 1) +
                            0.25 * std::cos(2 * u.z() - 0.5) * u.y() + 0.2 * u.z() * u.x() * u.x();
      x = radius * u.cwiseProduct(Vector3(1, 1.4, 0.8));
    } else {
      x.x() = -x.x();
    }
    points.row(i) = (rotation * x).transpose();
  }
  return points;
}

}  // namespace symsurf::benchmarks
