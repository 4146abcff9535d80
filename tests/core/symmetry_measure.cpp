#include "score/symmetry_measure.h"

#include <gtest/gtest.h>

#include "random_cloud.h"

namespace symsurf {
namespace {

// The definition, pair by pair.
double by_definition(const Points& points, const Eigen::Vector4d& p, double alpha) {
  const Vector3 n = p.head<3>();
  double sum = 0;
  for (Index i = 0; i < points.rows(); ++i) {
    const Vector3 x = points.row(i).transpose();
    const Vector3 image = x - 2 * (n.dot(x) + p[3]) / n.squaredNorm() * n;
    for (Index j = 0; j < points.rows(); ++j) {
      const double u = alpha * (image - points.row(j).transpose()).norm() / 2.6;
      if (u < 1) sum += wendland(u);
    }
  }
  return sum;
}

Eigen::Vector4d random_plane(RandomCloud& random) {
  Eigen::Vector4d p;
  p << random.uniform(0.3, 3) * random.direction(), random.uniform(-0.3, 0.3);
  return p;
}

TEST(SymmetryMeasure, IsTheSumOverAllPairs) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    RandomCloud random(seed);
    const Points points = random.sphere(300);
    const SymmetryMeasure measure(points);
    for (int trial = 0; trial < 5; ++trial) {
      const Eigen::Vector4d p = random_plane(random);
      EXPECT_NEAR(measure(p), by_definition(points, p, measure.alpha()), 1e-10) << seed;
    }
  }
}

TEST(SymmetryMeasure, GradientIsTheLimitOfDifferences) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    RandomCloud random(seed);
    const SymmetryMeasure measure(random.sphere(300));
    const Eigen::Vector4d p = random_plane(random);
    Eigen::Vector4d gradient;
    measure(p, &gradient);
    for (int k = 0; k < 4; ++k) {
      constexpr double step = 1e-6;
      const Eigen::Vector4d shift = step * Eigen::Vector4d::Unit(k);
      const double difference = (measure(p + shift) - measure(p - shift)) / (2 * step);
      EXPECT_NEAR(gradient[k], difference, 1e-5 * (1 + gradient.norm())) << seed << ' ' << k;
    }
  }
}

TEST(SymmetryMeasure, DoesNotDependOnTheLengthOfTheNormal) {
  RandomCloud random(0);
  const SymmetryMeasure measure(random.box(200));
  const Eigen::Vector4d p = random_plane(random);
  EXPECT_NEAR(measure(p), measure(-7 * p), 1e-10);
}

TEST(SymmetryMeasure, OneIsThePerfectMatchOfAPoint) {
  EXPECT_EQ(wendland(0), 1);
  EXPECT_EQ(wendland(1), 0);
}

}  // namespace
}  // namespace symsurf
