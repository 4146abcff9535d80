#include <gtest/gtest.h>
#include <symsurf/context.h>
#include <symsurf/detect.h>
#include <symsurf/synthetic.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "base/nelder_mead.h"
#include "expect_error.h"
#include "fit/shapes.h"
#include "random_cloud.h"

namespace symsurf::sphere_method_tests {
namespace {

struct Trial {
  Points points;
  Sphere truth;
};

// A graph or a bumpy blob, mirrored over a sphere through its middle, turned at random.
Trial trial(std::uint64_t seed, Index n = 1500) {
  RandomCloud random(seed);
  Points cloud(n, 3);
  const double bumps = random.uniform(2, 4), phase = random.uniform(0, 6);
  for (Index i = 0; i < n; ++i) {
    if (seed % 2) {
      const double x = random.uniform(-2, 2), y = random.uniform(-2, 2);
      cloud.row(i) << x, y, std::sin(x + phase) * std::cos(0.7 * y) + 0.2 * x * y;
    } else {
      const Vector3 u = random.direction();
      cloud.row(i) = (1 + 0.25 * std::sin(bumps * u.x() + phase) + 0.2 * u.y() * u.z()) *
                     Vector3(1.3 * u.x(), u.y(), 0.8 * u.z()).transpose();
    }
  }
  const double diagonal = (cloud.colwise().maxCoeff() - cloud.colwise().minCoeff()).norm();
  const Vector3 middle = cloud.colwise().mean();
  const double radius = random.uniform(0.5, 1) * diagonal;
  const Sphere sphere(middle + 0.8 * radius * random.direction(), radius);
  const Sample sample = mirror_spherical(cloud, sphere);
  const Matrix3 rotation = random.rotation();
  const auto turned = sphere.transformed(1, rotation, Vector3(5, 6, 7));
  return {(sample.points * rotation.transpose()).rowwise() + Eigen::RowVector3d(5, 6, 7),
          dynamic_cast<const Sphere&>(*turned)};
}

SphereErrors found_errors(const Points& points, const Sphere& truth) {
  Options options;
  options.method = "sphere";
  const Result result = detect(points, options);
  return sphere_errors(dynamic_cast<const Sphere&>(*result.mirror), truth, points);
}

TEST(SphereMethod, FindsCleanSpheresToRounding) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    SCOPED_TRACE(seed);
    const Trial t = trial(seed);
    const SphereErrors errors = found_errors(t.points, t.truth);
    EXPECT_LE(errors.e_c, 1e-6);
    EXPECT_LE(errors.e_r, 1e-6);
  }
}

// So large that a plane explains them nearly as well.
TEST(SphereMethod, FindsSpheresOfManyDiagonalsToRounding) {
  for (const double diagonals : {3, 10, 25})
    for (std::uint64_t seed = 0; seed < seeds; ++seed) {
      SCOPED_TRACE(testing::Message() << diagonals << " diagonals, seed " << seed);
      RandomCloud random(seed);
      constexpr Index n = 900;
      const Vector3 wave = 5 * random.direction();
      Points cloud(n, 3);
      for (Index i = 0; i < n; ++i) {
        const double x = random.uniform(-1, 1), y = random.uniform(-1, 1);
        cloud.row(i) << x, y, 0.2 * std::sin(wave.x() * x + wave.y() * y) + 0.1 * x * y * y - 0.7;
      }
      const double radius = 3 * diagonals;
      const Sphere sphere(Vector3(0.2, 0.1, -radius), radius);
      const Points points = mirror_spherical(cloud, sphere).points * random.rotation().transpose();
      Options options;
      options.method = "sphere";
      const Result result = detect(points, options);
      for (Index i = 0; i < n; ++i) {
        const Vector3 x = points.row(i), image = points.row(n + i);
        ASSERT_NEAR((result.mirror->reflect(x) - image).norm(), 0, 1e-11);
      }
      EXPECT_NEAR(dynamic_cast<const Sphere&>(*result.mirror).radius(), radius, 1e-6 * radius);
    }
}

// Where planes are all there is.
TEST(SphereMethod, MakesNoSphereOfAPlane) {
  RandomCloud random(1);
  Points grid(100, 3), surfaces(800, 3);
  for (Index i = 0; i < 100; ++i) grid.row(i) << i % 10, i / 10, 0;
  for (Index i = 0; i < 400; ++i) {
    const double x = random.uniform(0, 1), y = random.uniform(0, 1);
    const double z = 0.3 + 0.1 * std::sin(6 * x) * y;
    surfaces.row(2 * i) << x, y, z;
    surfaces.row(2 * i + 1) << x, y, -z;
  }
  Options options;
  options.method = "sphere";
  for (const Points& points : {grid, surfaces}) {
    const Result result = detect(points, options);
    if (!result.mirror) continue;
    const double diagonal = (points.colwise().maxCoeff() - points.colwise().minCoeff()).norm();
    EXPECT_LT(dynamic_cast<const Sphere&>(*result.mirror).radius(), 100 * diagonal);
  }
}

// At 10^4 points the noise is wider than their spacing: no point is near its partner.
TEST(SphereMethod, FindsSpheresThroughOnePercentNoise) {
  SYMSURF_FULL_RUN_ONLY();
  for (const Index n : {1500, 5000}) {
    std::uint64_t found = 0;
    for (std::uint64_t seed = 0; seed < seeds; ++seed) {
      const Trial t = trial(seed, n);
      const double diagonal =
          (t.points.colwise().maxCoeff() - t.points.colwise().minCoeff()).norm();
      const Points noisy = add_noise(t.points, 0, 0.01 * diagonal, {}, seed);
      found += found_errors(noisy, t.truth).e_c <= 1e-2;
    }
    EXPECT_GE(8 * found, 7 * seeds) << n;  // nearly nine tenths
  }
}

// Half a bumpy ball and its image.
Points shells(RandomCloud& random, const Sphere& sphere, double side) {
  constexpr Index n = 550;
  const Vector3 wave = 3 * random.direction(), cross = 4 * random.direction();
  Points points(2 * n, 3);
  for (Index i = 0; i < n; ++i) {
    Vector3 u = random.direction();
    u.z() = side * (0.1 + 0.9 * std::abs(u.z()));
    u.normalize();
    const double bumps = std::sin(wave.dot(u) + side) + std::cos(cross.dot(u));
    const double inner = sphere.radius() * (0.65 + 0.07 * bumps);
    points.row(i) = (sphere.centre() + inner * u).transpose();
    points.row(n + i) = (sphere.centre() + (2 * sphere.radius() - inner) * u).transpose();
  }
  return points;
}

// Two shapes in one cloud: each sphere mirrors one of them.
TEST(SphereMethod, ReportsBothSpheresOfAShapeWithTwo) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    SCOPED_TRACE(seed);
    RandomCloud random(seed);
    const Sphere one(Vector3(0, 0.3, 0), 2), other(Vector3(0, -0.3, 0), 2.6);
    const Points upper = shells(random, one, 1), lower = shells(random, other, -1);
    Points points(upper.rows() + lower.rows(), 3);
    points << upper, lower;
    Options options;
    options.method = "sphere";
    const Result result = detect(points, options);
    for (const Sphere& truth : {one, other}) {
      const auto is_truth = [&](const Result& found) {
        const auto& sphere = dynamic_cast<const Sphere&>(*found.mirror);
        return sphere_errors(sphere, truth, points).e_c <= 1e-2;
      };
      EXPECT_TRUE(is_truth(result) ||
                  std::any_of(result.candidates.begin(), result.candidates.end(), is_truth))
          << "radius " << truth.radius();
    }
  }
}

// Four shells about one centre: the plane through it that fits best must not crowd out the sphere.
TEST(SphereMethod, FindsTheSphereAmidNestedBalls) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    SCOPED_TRACE(seed);
    RandomCloud random(seed);
    constexpr Index n = 600;
    const Vector3 wave = 3 * random.direction();
    Points points(4 * n, 3);
    for (Index i = 0; i < n; ++i) {
      const Vector3 u = random.direction();
      const double bump = 0.15 * std::sin(wave.dot(u));
      const std::array<double, 4> radii{1 + bump, 2 - bump, 3 + bump, 4 - bump};
      for (Index k = 0; k < 4; ++k) points.row(4 * i + k) = radii[k] * u.transpose();
    }
    const SphereErrors errors = found_errors(points, Sphere(Vector3::Zero(), 2.5));
    EXPECT_LE(errors.e_c, 1e-6);
    EXPECT_LE(errors.e_r, 1e-6);
  }
}

TEST(NelderMead, ClimbsToTheMaximum) {
  const Eigen::Vector4d top(1, -2, 3, 0.5), weights(1, 4, 0.5, 2);
  const auto hill = [&](const Eigen::Vector4d& x) { return -(x - top).cwiseAbs2().dot(weights); };
  int evaluations = 2000;
  const Eigen::Vector4d start = Eigen::Vector4d::Zero();
  const Eigen::Vector4d found = nelder_mead<4>(hill, start, 0.1, 1e-10, evaluations);
  EXPECT_NEAR((found - top).norm(), 0, 1e-7);
  EXPECT_LT(evaluations, 2000);
}

TEST(SphereThesis, RefusesRadiiOutOfOrder) {
  Options options;
  options.method = "sphere_thesis";
  options.parameters = {{"min_radius_divisor", 3.0}, {"max_radius_divisor", 5.0}};
  expect_error<InvalidParameter>("min_radius_divisor is 3",
                                 [&] { detect(trial(1).points, options); });
}

// Few points in clusters of a thousandth of their distance: parts of the cloud have no extent.
TEST(SphereMethod, TakesClusters) {
  int answered = 0;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    RandomCloud random(seed);
    const Index clusters = 2 + static_cast<Index>(seed % 4);
    const Points middles = random.box(clusters), around = 1e-3 * random.box(15);
    Points points(15, 3);
    for (Index i = 0; i < points.rows(); ++i)
      points.row(i) = middles.row(i % clusters) + around.row(i);
    try {
      const Result result = detect(points, {.method = "sphere"});
      EXPECT_TRUE(std::isfinite(result.score)) << seed;
      ++answered;
    } catch (const InvalidInput&) {
    }
  }
  EXPECT_GT(answered, 0);
}

}  // namespace
}  // namespace symsurf::sphere_method_tests
