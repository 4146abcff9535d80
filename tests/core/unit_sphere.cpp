#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "cloud/principal_frame.h"
#include "fit/fitted.h"
#include "fit/shapes.h"
#include "random_cloud.h"

namespace symsurf::unit_sphere_tests {
namespace {

// Through the cloud's box; of either sign, or a plane.
constexpr std::array curvatures{-1.0, -0.1, -1e-6, 0.0, 1e-9, 0.01, 0.7};

UnitSphere random_sphere(RandomCloud& random, double curvature) {
  return {0.3 * random.in_box(), random.direction(), curvature};
}

TEST(UnitSphere, IsThePlaneWhereCurvatureVanishes) {
  RandomCloud random(1);
  for (int k = 0; k < 20; ++k) {
    const UnitSphere sphere = random_sphere(random, 0);
    const UnitPlane plane{sphere.normal, -sphere.normal.dot(sphere.point)};
    const Vector3 x = random.in_box(), v = random.direction();
    EXPECT_NEAR(sphere.distance(x), plane.distance(x), 1e-15);
    EXPECT_NEAR((sphere.reflect(x) - plane.reflect(x)).norm(), 0, 2e-15);
    EXPECT_NEAR((sphere.reflect_direction(x, v) - plane.reflect_direction(v)).norm(), 0, 2e-15);
  }
}

TEST(UnitSphere, IsTheSphereAboutItsCentre) {
  RandomCloud random(2);
  for (const double curvature : curvatures) {
    if (std::abs(curvature) < 1e-3) continue;
    const UnitSphere sphere = random_sphere(random, curvature);
    const Sphere truth(sphere.centre(), sphere.radius());
    for (int k = 0; k < 20; ++k) {
      const Vector3 x = 0.5 * random.in_box();
      const double side = curvature > 0 ? 1 : -1;
      EXPECT_NEAR(side * sphere.distance(x), truth.signed_distance(x), 1e-13);
      EXPECT_NEAR((sphere.reflect(x) - truth.reflect(x)).norm(), 0, 1e-13);
    }
  }
}

TEST(UnitSphere, HasNoImageBeyondTwiceItsRadius) {
  const UnitSphere sphere{Vector3::UnitX(), Vector3::UnitX(), 1};
  EXPECT_TRUE(sphere.reflect({1.9, 0, 0}).allFinite());
  EXPECT_FALSE(sphere.reflect({2.1, 0, 0}).allFinite());
  EXPECT_FALSE(sphere.reflect({0, 0, 0}).allFinite());
}

TEST(UnitSphere, IsFoundFromItsPairsInAFewSteps) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed)
    for (const double curvature : curvatures) {
      RandomCloud random(seed);
      const UnitSphere truth = random_sphere(random, curvature);
      const Points cloud = 0.4 * random.box(30);
      UnitSphere sphere = truth.changed({0.05, -0.04, 0.03, 0.1});
      for (int step = 0; step < 6; ++step) {
        GaussNewton<UnitSphere> sum;
        for (Index i = 0; i < cloud.rows(); ++i) {
          const Vector3 x = cloud.row(i);
          const Vector3 gap = sphere.reflect(x) - truth.reflect(x);
          if (gap.allFinite()) sum.add(sphere, x, gap, Metric{1, 0, Vector3::Zero()}, 1);
        }
        sphere = sum.taken(sphere).first;
      }
      for (Index i = 0; i < cloud.rows(); ++i)
        EXPECT_NEAR(sphere.distance(cloud.row(i)), truth.distance(cloud.row(i)), 1e-13)
            << curvature;
    }
}

}  // namespace
}  // namespace symsurf::unit_sphere_tests
