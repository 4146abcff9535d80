#include <gtest/gtest.h>

#include "fit/bent_plane.h"
#include "random_cloud.h"

namespace symsurf {
namespace {

using At = HeightSpline::At;

HeightSpline random_spline(RandomCloud& random) {
  HeightSpline spline(At(-1, -0.4), At(0.7, 0.9), random.uniform(0.2, 0.6));
  Eigen::VectorXd by(spline.size());
  for (double& height : by) height = random.uniform(-1, 1);
  spline.step(by);
  return spline;
}

At random_place(const HeightSpline& spline, RandomCloud& random) {
  const At share(random.uniform(0, 1), random.uniform(0, 1));
  return spline.low() + (spline.high() - spline.low()).cwiseProduct(share);
}

TEST(HeightSpline, CoversTheRectangleFlat) {
  const HeightSpline spline(At(-1, -0.4), At(0.7, 0.9), 0.5);
  EXPECT_TRUE((spline.low().array() <= Eigen::Array2d(-1, -0.4)).all());
  EXPECT_TRUE((spline.high().array() >= Eigen::Array2d(0.7, 0.9)).all());
  EXPECT_EQ(spline.jet(At(0.1, 0.2)).h, 0);
}

TEST(HeightSpline, HasTheDerivativesOfItsHeights) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    RandomCloud random(seed);
    const HeightSpline spline = random_spline(random);
    constexpr double step = 1e-5;
    for (int k = 0; k < 20; ++k) {
      const At at = random_place(spline, random);
      const auto jet = spline.jet(at);
      const auto left = spline.jet(at - At(step, 0)), right = spline.jet(at + At(step, 0));
      const auto below = spline.jet(at - At(0, step)), above = spline.jet(at + At(0, step));
      EXPECT_NEAR(jet.u, (right.h - left.h) / (2 * step), 1e-6);
      EXPECT_NEAR(jet.v, (above.h - below.h) / (2 * step), 1e-6);
      EXPECT_NEAR(jet.uu, (right.u - left.u) / (2 * step), 1e-3);
      EXPECT_NEAR(jet.uv, (right.v - left.v) / (2 * step), 1e-3);
      EXPECT_NEAR(jet.vv, (above.v - below.v) / (2 * step), 1e-3);
    }
  }
}

TEST(HeightSpline, KeepsItsHeightsWhenSubdivided) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    RandomCloud random(seed);
    const HeightSpline spline = random_spline(random), finer = spline.subdivided();
    EXPECT_GT(finer.size(), spline.size());
    for (int k = 0; k < 50; ++k) {
      const At at = random_place(spline, random);
      EXPECT_NEAR(finer.jet(at).h, spline.jet(at).h, 1e-12);
      EXPECT_NEAR(finer.jet(at).uv, spline.jet(at).uv, 1e-9);
    }
  }
}

// By the midpoint rule over many positions, third derivatives by differences of second ones.
TEST(HeightSpline, HasTheCurvatureVariationOfItsHeights) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    RandomCloud random(seed);
    const HeightSpline spline = random_spline(random);
    constexpr int side = 200;
    constexpr double step = 1e-4;
    double sum = 0;
    for (int a = 0; a < side; ++a)
      for (int b = 0; b < side; ++b) {
        const At share((a + 0.5) / side, (b + 0.5) / side);
        const At at = spline.low() + (spline.high() - spline.low()).cwiseProduct(share);
        const auto left = spline.jet(at - At(step, 0)), right = spline.jet(at + At(step, 0));
        const auto below = spline.jet(at - At(0, step)), above = spline.jet(at + At(0, step));
        const auto squared = [](double x) { return x * x; };
        sum += (squared(right.uu - left.uu) + 3 * squared(right.uv - left.uv) +
                3 * squared(above.uv - below.uv) + squared(above.vv - below.vv)) /
               squared(2 * step);
      }
    const Eigen::VectorXd& c = spline.coefficients();
    EXPECT_NEAR(c.dot(spline.curvature_variation() * c), sum / (side * side),
                0.1 * sum / (side * side));
  }
}

// A saddle's curvature is the same everywhere: the coefficients' products i j make u v.
TEST(HeightSpline, LetsASaddleBendForNothing) {
  HeightSpline spline(At(0, 0), At(4, 3), 1);
  Eigen::VectorXd product(spline.size());
  for (Index k = 0; k < product.size(); ++k) product[k] = static_cast<double>((k / 6) * (k % 6));
  spline.step(product);
  EXPECT_NEAR(spline.jet(At(1, 1)).uv, 1, 1e-12);
  EXPECT_NEAR(product.dot(spline.curvature_variation() * product), 0, 1e-9);
}

}  // namespace
}  // namespace symsurf
