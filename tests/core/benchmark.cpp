#include <gtest/gtest.h>
#include <symsurf/context.h>
#include <symsurf/synthetic.h>

#include <cmath>
#include <vector>

#include "expect_error.h"
#include "synthetic/generators.h"

namespace symsurf::benchmark_tests {
namespace {

TEST(PortableSine, IsTheLibrarysToRounding) {
  constexpr double tau = 6.283185307179586476925;
  for (double turns = -3; turns < 3; turns += 0.00137) {
    EXPECT_NEAR(sine_of_turns(turns), std::sin(tau * turns), 1e-14);
    EXPECT_NEAR(cosine_of_turns(turns), std::cos(tau * turns), 1e-14);
  }
}

std::vector<Vector3> points_of(const char* shape, bool symmetric, std::uint64_t seed) {
  Random random(seed);
  const auto body = random_body(shape, symmetric, random);
  std::vector<Vector3> points;
  for (int k = 0; k < 400; ++k) points.push_back(body->point(random));
  return points;
}

// The sum of squared distances from the images of displaced points to the points' displaced images.
double missed(const SmoothAsymmetry& displaced, const std::vector<Vector3>& points,
              const Vector3& normal, double offset) {
  double sum = 0;
  for (const Vector3& x : points) {
    const Vector3 p = displaced(x), q = displaced(over_mirror(x));
    for (const auto& [from, to] : {std::pair(p, q), std::pair(q, p)})
      sum += (from - 2 * (normal.dot(from) + offset) * normal - to).squaredNorm();
  }
  return sum;
}

TEST(SmoothAsymmetry, LeavesThePlaneOfLeastSquares) {
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    const std::vector<Vector3> points = points_of("creature", true, seed);
    Random random(seed + 100);
    const SmoothAsymmetry displaced(0.03, points, random);
    const double least = missed(displaced, points, Vector3::UnitZ(), 0);
    EXPECT_GT(least, 1e-3);
    constexpr double step = 1e-3;
    for (const double sign : {-1, 1}) {
      EXPECT_GT(missed(displaced, points, Vector3::UnitZ(), sign * step), least);
      for (int axis = 0; axis < 2; ++axis) {
        const Vector3 tilted = (Vector3::UnitZ() + sign * step * Vector3::Unit(axis)).normalized();
        EXPECT_GT(missed(displaced, points, tilted, 0), least) << seed;
      }
    }
  }
}

TEST(SmoothAsymmetry, MovesPointsAsFarAsItSays) {
  const std::vector<Vector3> points = points_of("head", true, 1);
  for (const double share : {0.0, 0.01, 0.03}) {
    Random random(2);
    const SmoothAsymmetry displaced(share, points, random);
    Vector3 shift = Vector3::Zero();
    for (const Vector3& x : points) shift += (displaced(x) - x) / points.size();
    double squares = 0;
    for (const Vector3& x : points) squares += (displaced(x) - x - shift).squaredNorm();
    // A rigid motion comes after it.
    EXPECT_LE(std::sqrt(squares / points.size()), 2 * share);
    EXPECT_GE(std::sqrt(squares / points.size()), 0.3 * share);
  }
}

TEST(BenchmarkMirror, KeepsImagesImagesAndIsUndone) {
  Random random(3);
  for (const char* bend : {"straight", "bent", "domed", "waved", "twisted"})
    for (int trial = 0; trial < 20; ++trial) {
      const BenchmarkMirror plane(bend, 0.25, random);
      const Vector3 x(random.uniform(-0.4, 0.4), random.uniform(-0.3, 0.3),
                      random.uniform(-0.25, 0.25));
      const Vector3 foot = plane.bent({x.x(), x.y(), 0});
      const Vector3 p = plane.bent(x), q = plane.bent(over_mirror(x));
      EXPECT_NEAR((p - foot).norm(), std::abs(x.z()), 1e-14) << bend;
      EXPECT_NEAR(((p + q) / 2 - foot).norm(), 0, 1e-14) << bend;
      for (int axis = 0; axis < 2; ++axis) {  // along the normal
        constexpr double h = 1e-6;
        const Vector3 step = h * Vector3::Unit(axis), base(x.x(), x.y(), 0);
        const Vector3 along = (plane.bent(base + step) - plane.bent(base - step)) / (2 * h);
        EXPECT_NEAR((p - foot).dot(along), 0, 1e-8) << bend;
      }
      const Vector3 start = x + 0.02 * random.direction();
      EXPECT_NEAR((plane.straightened(p, start) - x).norm(), 0, 1e-12) << bend;
    }
}

TEST(RandomBody, ImagesOfASymmetricOneLieOnIt) {
  for (const char* shape : {"creature", "head", "part", "mask", "sheets"})
    for (const bool symmetric : {true, false}) {
      const std::vector<Vector3> points = points_of(shape, symmetric, 4);
      double missed = 0, spacing = 0;
      for (std::size_t k = 0; k < 100; ++k) {
        double near = 1e9, other = 1e9;
        for (std::size_t j = 0; j < points.size(); ++j) {
          near = std::min(near, (points[j] - over_mirror(points[k])).norm());
          if (j != k) other = std::min(other, (points[j] - points[k]).norm());
        }
        missed += near;
        spacing += other;
      }
      // A point at a random place of a surface is as far from the nearest as that is from others.
      EXPECT_EQ(missed < 1.3 * spacing, symmetric) << shape << missed / spacing;
    }
}

TEST(Benchmark, RefusesWhatIsNoCase) {
  expect_error<InvalidParameter>("head-curly", [] { benchmark_sample("head-curly", 1000, 0); });
  expect_error<InvalidParameter>("count is 5", [] { benchmark_sample("head-bent-clean", 5, 0); });
  EXPECT_EQ(benchmark_cases().size(), 260);
}

}  // namespace
}  // namespace symsurf::benchmark_tests
