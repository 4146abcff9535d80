#include <gtest/gtest.h>
#include <symsurf/context.h>
#include <symsurf/mirrors.h>
#include <symsurf/synthetic.h>

#include <cmath>

#include "expect_error.h"
#include "random_cloud.h"

namespace symsurf::synthetic_tests {
namespace {

// Where f1 to f6 are all defined and smooth.
Vector3 inside_disc(RandomCloud& random) {
  for (;;) {
    const Vector3 x = random.in_box();
    if (x.head<2>().norm() < 0.9 && x.head<2>().norm() > 0.1 && std::abs(x.y()) > 0.1) return x;
  }
}

TEST(Surface, GradientsAreThoseOfTheHeights) {
  constexpr double h = 1e-5;
  RandomCloud random(1);
  for (const Surface& f : surfaces())
    for (int trial = 0; trial < 50; ++trial) {
      const Vector3 x = inside_disc(random);
      const Eigen::Vector2d numeric((f(x.x() + h, x.y()) - f(x.x() - h, x.y())) / (2 * h),
                                    (f(x.x(), x.y() + h) - f(x.x(), x.y() - h)) / (2 * h));
      EXPECT_NEAR((f.gradient(x.x(), x.y()) - numeric).norm(), 0, 1e-8) << f.name;
    }
}

TEST(Surface, HasTheValuesOfItsFormula) {
  EXPECT_DOUBLE_EQ(surface("f1")(1, 2), std::sin(0.7) * std::cos(1.4));
  EXPECT_DOUBLE_EQ(surface("f2")(1, 2), std::sin(3.5) / 0.7);
  EXPECT_DOUBLE_EQ(surface("f3")(3, 4), 5);
  EXPECT_DOUBLE_EQ(surface("f4")(7, -3), -2);
  EXPECT_NEAR(surface("f5")(0.35, 9),
              (std::sin(-1.0) + std::sin(-0.7) + std::sin(-0.4) + std::sin(0.2)) / 7, 1e-16);
  EXPECT_DOUBLE_EQ(surface("f6")(0.6, 0), 0.8);
  EXPECT_TRUE(std::isnan(surface("f6")(0.8, 0.8)));
  expect_error<InvalidParameter>("f1, f2, f3, f4, f5, f6", [] { surface("f7"); });
}

// No point of a fine scan of the graph is closer than the one found.
TEST(SurfaceMirror, FindsTheClosestPoint) {
  RandomCloud random(2);
  for (const Surface& f : surfaces())
    for (int trial = 0; trial < 20; ++trial) {
      const Vector3 x = 1.5 * random.in_box();
      const SurfaceMirror mirror(f, Mapping::Perpendicular);
      const Vector3 foot = mirror.foot(x);
      EXPECT_NEAR(f.name == "f6" ? 1 - foot.norm() : f(foot.x(), foot.y()) - foot.z(), 0, 1e-15);
      const double found = (foot - x).norm();
      EXPECT_NEAR(std::abs(mirror.signed_distance(x)), found, 1e-14);
      for (double s = -3; s <= 3; s += 0.02)
        for (double t = -3; t <= 3; t += 0.02) {
          const double z = f(s, t);
          if (!std::isfinite(z)) continue;
          ASSERT_GT((Vector3(s, t, z) - x).norm(), found - 1e-12) << f.name;
        }
    }
}

TEST(SurfaceMirror, HasNoFootForWhatIsNoPoint) {
  for (const Surface& f : surfaces())
    for (const Mapping mapping : {Mapping::Fixed, Mapping::Perpendicular})
      for (const double z : {NAN, INFINITY}) {
        const SurfaceMirror mirror(f, mapping);
        EXPECT_TRUE(std::isnan(mirror.signed_distance(Vector3(z, 0, 0)))) << f.name;
        EXPECT_TRUE(mirror.foot(Vector3(z, 0, 0)).hasNaN()) << f.name;
      }
}

TEST(SurfaceMirror, MovesWithItsPoints) {
  RandomCloud random(3);
  for (const Mapping mapping : {Mapping::Fixed, Mapping::Perpendicular})
    for (std::uint64_t seed = 0; seed < seeds; ++seed) {
      const SurfaceMirror mirror(surface("f1"), mapping);
      const Matrix3 rotation = random.rotation();
      const Vector3 shift = random.in_box(), x = random.in_box();
      const auto moved = mirror.transformed(2, rotation, shift);
      const auto again =
          moved->transformed(0.5, rotation.transpose(), -0.5 * (rotation.transpose() * shift));
      const Vector3 expected = 2 * rotation * mirror.reflect(x) + shift;
      EXPECT_NEAR((moved->reflect(2 * rotation * x + shift) - expected).norm(), 0, 1e-9);
      EXPECT_NEAR((again->reflect(x) - mirror.reflect(x)).norm(), 0, 1e-9);
    }
}

TEST(SurfaceMirror, MeshesOnlyWhereItIsDefined) {
  const SurfaceMirror mirror(surface("f6"), Mapping::Fixed);
  const Points object = sampled_surface(surface("f6"), 1, 30);
  const Mesh mesh = mirror.mesh(object, 20);
  ASSERT_GT(mesh.triangles.rows(), 100);
  ASSERT_LT(mesh.triangles.maxCoeff(), mesh.vertices.rows());
  for (const auto& v : mesh.vertices.rowwise()) EXPECT_NEAR(v.norm(), 1, 1e-14);
}

TEST(MirrorFixed, PutsTheSurfaceMidwayInTheDirection) {
  RandomCloud random(4);
  const Points cloud = random.box(100);
  for (const Surface& f : surfaces())
    for (const Vector3& direction : {Vector3(0, 0, 1), Vector3(0, 0, -2), random.direction()}) {
      const Sample sample = mirror_fixed(cloud, f, 0.5, direction);
      const auto& truth = dynamic_cast<const SurfaceMirror&>(*sample.truth);
      EXPECT_EQ(2 * sample.pairs.rows(), sample.points.rows());
      EXPECT_EQ(sample.pairs.rows() + sample.skipped, cloud.rows());
      EXPECT_EQ(sample.skipped > 0, f.name == "f6");
      for (const auto& pair : sample.pairs.rowwise()) {
        const Vector3 p = sample.points.row(pair[0]), q = sample.points.row(pair[1]);
        EXPECT_NEAR((p - q).cross(direction.normalized()).norm(), 0, 1e-14);
        const Vector3 middle = truth.to_frame((p + q) / 2);
        EXPECT_NEAR(middle.z(), f(middle.x(), middle.y()), 1e-14);
        EXPECT_NEAR((sample.truth->reflect(p) - q).norm(), 0, 1e-14);
      }
    }
  const Sample plain = mirror_fixed(cloud, surface("f1"), 0.5);
  EXPECT_EQ(plain.points.topRows(100).leftCols<2>(), cloud.leftCols<2>());
  EXPECT_EQ(plain.points.bottomRows(100).leftCols<2>(), cloud.leftCols<2>());
  EXPECT_NEAR((plain.points.topRows(100).col(2) - cloud.col(2)).minCoeff(), 0.5, 1e-15);
}

TEST(MirrorPerpendicular, MovesAlongTheNormals) {
  for (const Surface& f : surfaces()) {
    const Sample sample = mirror_perpendicular(f, 1, 21, 0.1, 0.3, 0);
    EXPECT_EQ(sample.pairs.rows() + sample.skipped, 21 * 21);
    for (const auto& pair : sample.pairs.rowwise()) {
      const Vector3 p = sample.points.row(pair[0]), q = sample.points.row(pair[1]);
      const Vector3 s = (p + q) / 2;
      EXPECT_NEAR((p - q).norm(), 0.2, 1e-13);
      EXPECT_NEAR(s.z(), f(s.x(), s.y()), 1e-12);
      const Eigen::Vector2d slope = f.gradient(s.x(), s.y());
      if (std::abs(s.y()) < 1e-9 || !slope.allFinite() || slope.norm() > 1e3) continue;
      EXPECT_NEAR((p - q).cross(Vector3(slope.x(), slope.y(), -1).normalized()).norm(), 0, 1e-9)
          << f.name;
    }
  }
}

TEST(MirrorPerpendicular, ChangesTheDistanceInWaves) {
  constexpr double extent = 2, low = 0.1, high = 0.5;
  for (const Index waves : {0, 1, 2, 3}) {
    const Sample sample = mirror_perpendicular(surface("f4"), extent, 41, low, high, waves);
    for (const auto& pair : sample.pairs.rowwise()) {
      const Vector3 p = sample.points.row(pair[0]), q = sample.points.row(pair[1]);
      const double along = ((p + q).x() / 2 + extent) / (2 * extent);
      // Legs: even ones rise, odd ones fall.
      const double phase = along * static_cast<double>(waves);
      const double fraction = phase - std::floor(phase);
      const double rise = static_cast<Index>(std::floor(phase)) % 2 == 0 ? fraction : 1 - fraction;
      const double expected = waves == 0 ? low : low + (high - low) * rise;
      EXPECT_NEAR((p - q).norm() / 2, expected, 1e-12) << waves;
    }
  }
}

TEST(MirrorSpherical, KeepsWhatLiesInsideAndItsImages) {
  RandomCloud random(5);
  const Points cloud = random.box(400);
  const Sphere sphere(Vector3(0.3, 0, 0), 0.8);
  const Sample sample = mirror_spherical(cloud, sphere);
  EXPECT_EQ(
      sample.pairs.rows(),
      ((cloud.rowwise() - sphere.centre().transpose()).rowwise().norm().array() < 0.8).count());
  for (const auto& pair : sample.pairs.rowwise()) {
    const Vector3 u = Vector3(sample.points.row(pair[0])) - sphere.centre();
    const Vector3 v = Vector3(sample.points.row(pair[1])) - sphere.centre();
    EXPECT_NEAR(u.norm() + v.norm(), 1.6, 1e-14);
    EXPECT_NEAR(u.cross(v).norm(), 0, 1e-14);
  }
}

TEST(MirrorSpherical, PlacesTheSphereBetweenVertices) {
  const Vector3 first(1, 2, 3), second(1, 2, 7);
  const Sphere sphere = sphere_between(first, second, 10);
  EXPECT_EQ(sphere.centre(), Vector3(1, 2, -5));
  EXPECT_NEAR((sphere.reflect(first) - second).norm(), 0, 1e-14);
  expect_error<InvalidInput>("differ", [&] { sphere_between(first, first, 1); });
}

TEST(Generators, RunFromTheirDescriptions) {
  for (const Generator& generator : generators()) {
    const Sample sample = generate(generator.name);
    EXPECT_GT(sample.points.rows(), 100) << generator.name;
    ASSERT_TRUE(sample.truth) << generator.name;
    EXPECT_EQ(generate(generator.name).points, sample.points);
  }
  expect_error<InvalidParameter>("fixed, perpendicular, spherical", [] { generate("none"); });
  expect_error<InvalidParameter>("f1 | f2", [] { generate("fixed", {{"surface", "g"}}); });
}

TEST(Generators, SayWhatIsWrong) {
  const Surface& f6 = surface("f6");
  Points far(1, 3);
  far << 5, 5, 0;
  expect_error<InvalidInput>("undefined everywhere", [&] { mirror_fixed(far, f6); });
  expect_error<InvalidInput>("0 points", [&] { mirror_fixed({}, f6); });
  expect_error<InvalidParameter>("direction", [&] { mirror_fixed(far, f6, 0, {0, 0, 0}); });
  expect_error<InvalidParameter>("resolution is 1", [&] { sampled_surface(f6, 1, 1); });
  expect_error<InvalidParameter>("extent", [&] { sampled_surface(f6, -1, 9); });
  expect_error<InvalidParameter>("min_distance", [&] { mirror_perpendicular(f6, 1, 9, -1, 2); });
  expect_error<InvalidParameter>("max_distance is 0.1",
                                 [&] { mirror_perpendicular(f6, 1, 9, 0.2, 0.1, 1); });
  expect_error<InvalidInput>("inside the sphere",
                             [&] { mirror_spherical(far, Sphere(Vector3::Zero(), 1)); });
}

}  // namespace
}  // namespace symsurf::synthetic_tests
