#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "base/linear_algebra.h"
#include "random_cloud.h"

namespace symsurf::symmetric_eigen_tests {
namespace {

Matrix3 turned(const Vector3& values, const Matrix3& axes) {
  const Matrix3 m = axes * values.asDiagonal() * axes.transpose();
  return (m + m.transpose()) / 2;
}

TEST(LeastEigen, IsThatOfTheMatrixAtAnyScale) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    RandomCloud random(seed);
    for (const Vector3& values : {Vector3(0, 0.6, 1), Vector3(1e-6, 0.5, 1), Vector3(0.02, 1, 1),
                                  Vector3(0.3, 0.5, 1), Vector3(0.5, 0.6, 1), Vector3(0, 1e-3, 1)})
      for (const double scale : {1e-20, 1.0, 1e20}) {
        const Matrix3 axes = random.rotation();
        const LeastEigen least = least_eigen_of(scale * turned(values, axes));
        EXPECT_NEAR(least.value, scale * values[0], 1e-14 * scale) << seed << ' ' << values;
        EXPECT_NEAR(least.next, scale * values[1], 1e-7 * scale) << seed << ' ' << values;
        EXPECT_NEAR(least.greatest, scale * values[2], 1e-7 * scale) << seed << ' ' << values;
        EXPECT_NEAR(least.vector.norm(), 1, 1e-14);
        EXPECT_LT(least.vector.cross(axes.col(0)).norm(), 1e-11) << seed << ' ' << values;
      }
  }
}

// Where others are as small, any vector amid theirs will do.
TEST(LeastEigen, IsOneOfSeveralAlike) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    RandomCloud random(seed);
    for (const Vector3& values :
         {Vector3(0.5, 0.5, 1), Vector3(0, 0, 1), Vector3(1, 1, 1), Vector3(0, 0, 0)}) {
      const Matrix3 axes = random.rotation();
      const LeastEigen least = least_eigen_of(turned(values, axes));
      EXPECT_NEAR(least.value, values[0], 1e-7) << seed << ' ' << values;
      EXPECT_NEAR(least.greatest, values[2], 1e-7) << seed << ' ' << values;
      EXPECT_NEAR(least.vector.norm(), 1, 1e-14) << seed << ' ' << values;
      if (!(values[0] < values[2])) continue;
      EXPECT_LT(std::abs(least.vector.dot(axes.col(2))), 1e-4) << seed << ' ' << values;
    }
  }
}

TEST(LeastRotation, TakesADirectionToAnotherByTheAngleBetweenThem) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    RandomCloud random(seed);
    const Matrix3 axes = random.rotation();
    const Vector3 from = 3 * axes.col(0);
    for (const double angle :
         {0.0, 1e-9, 1.0, 3.0, 3.14159, std::numbers::pi - 1e-7, std::numbers::pi}) {
      const Vector3 onto = 2 * (std::cos(angle) * axes.col(0) + std::sin(angle) * axes.col(1));
      const Matrix3 turn = least_rotation(from, onto);
      EXPECT_LT((turn * from.normalized() - onto.normalized()).norm(), 1e-14)
          << seed << ' ' << angle;
      EXPECT_LT((turn * turn.transpose() - Matrix3::Identity()).norm(), 1e-14);
      EXPECT_NEAR(turn.determinant(), 1, 1e-14);
      EXPECT_NEAR(turn.trace(), 1 + 2 * std::cos(angle), 1e-12) << seed << ' ' << angle;
    }
  }
}

}  // namespace
}  // namespace symsurf::symmetric_eigen_tests
