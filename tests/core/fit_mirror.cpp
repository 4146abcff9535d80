#include <gtest/gtest.h>
#include <symsurf/detect.h>
#include <symsurf/mirrors.h>

#include <cmath>
#include <memory>
#include <vector>

#include "expect_error.h"
#include "random_cloud.h"

namespace symsurf::fit_mirror_tests {
namespace {

// Mirrors about as large as what lies on them.
std::vector<std::shared_ptr<Mirror>> drawn_mirrors(RandomCloud& random) {
  const Vector3 way = random.direction();
  const Vector3 away = 0.5 * random.direction();
  const double size = random.uniform(0.5, 1.5);
  const Vector3 bends(size, -random.uniform(0.3, 0.6), 0);
  return {std::make_shared<Plane>(way, 0.2 * size), std::make_shared<Sphere>(away, size),
          std::make_shared<Cylinder>(away, way, size),
          std::make_shared<Quadric>(Matrix3(bends.asDiagonal()), Vector3(0, 0, -1), 0.1)};
}

// The feet of random points.
Points on(const Mirror& mirror, RandomCloud& random, Index count) {
  Points feet(count, 3);
  for (Index i = 0; i < count;) {
    if (const auto foot = mirror.at(random.in_box())) feet.row(i++) = foot->point.transpose();
  }
  return feet;
}

double off(const Mirror& a, const Mirror& b, const Points& points) {
  return (a.reflect(PointsView(points)) - b.reflect(PointsView(points)))
      .rowwise()
      .norm()
      .maxCoeff();
}

TEST(FitMirror, FindsTheKindThatExactSamplesLieOn) {
  for (std::uint64_t seed = 0; seed < slow_seeds; ++seed) {
    RandomCloud random(seed);
    for (const auto& mirror : drawn_mirrors(random)) {
      SCOPED_TRACE(std::string(mirror->kind()) + " " + std::to_string(seed));
      const Points feet = on(*mirror, random, 400);
      const Points beside = feet + 0.05 * on(Sphere(Vector3::Zero(), 1), random, 400);
      for (const std::string_view kind : {std::string_view("auto"), mirror->kind()}) {
        const auto found = fit_mirror(feet, kind);
        EXPECT_EQ(found->kind(), mirror->kind());
        EXPECT_LT(off(*found, *mirror, beside), 1e-9);
        EXPECT_EQ(found->footprint().matrix(), feet);
      }
    }
  }
}

// Its points' centroid is its centre.
TEST(FitMirror, FindsAWholeSphere) {
  RandomCloud random(6);
  Points ways(200, 3);
  for (Index i = 0; i < ways.rows(); i += 2) {
    ways.row(i) = random.direction().transpose();
    ways.row(i + 1) = -ways.row(i);
  }
  const Sphere sphere(Vector3(1, 2, 3), 2);
  const Points points = (2 * ways).rowwise() + sphere.centre().transpose();
  for (const std::string_view kind : {"auto", "sphere"}) {
    const auto found = fit_mirror(points, kind);
    EXPECT_EQ(found->kind(), "sphere");
    EXPECT_LT(off(*found, sphere, 1.2 * points), 1e-9);
  }
}

TEST(FitMirror, PassesOverPointsThatLieElsewhere) {
  RandomCloud random(7);
  for (const auto& mirror : drawn_mirrors(random)) {
    SCOPED_TRACE(mirror->kind());
    Points points = on(*mirror, random, 500);
    for (Index i = 0; i < 100; ++i) points.row(5 * i).array() += random.uniform(-0.5, 0.5);
    const auto found = fit_mirror(points, mirror->kind());
    const Points beside = points + 0.05 * on(Sphere(Vector3::Zero(), 1), random, 500);
    EXPECT_LT(off(*found, *mirror, beside), 1e-6);
  }
}

TEST(FitMirror, IsAFreeFormThroughAWave) {
  RandomCloud random(3);
  Points wave(2000, 3);
  for (Index i = 0; i < wave.rows(); ++i) {
    const Vector3 x = random.in_box();
    const double u = x[0], v = x[1];
    wave.row(i) << u, v, 0.2 * std::sin(3 * u) * std::cos(2 * v);
  }
  const auto found = fit_mirror(wave);
  EXPECT_EQ(found->kind(), "free-form");
  const Eigen::VectorXd distance = found->signed_distance(wave);
  EXPECT_LT(distance.cwiseAbs().maxCoeff(), 1e-3);

  const Vector3 up(0.3, 0.1, 1);
  const auto along = fit_mirror(wave, "auto", up);
  EXPECT_EQ(along->kind(), "height field");
  EXPECT_LT((along->direction(*along->at(wave.row(0).transpose())) - up.normalized()).norm(),
            1e-12);
}

TEST(FitMirror, IsAnObliquePlaneAlongADirection) {
  RandomCloud random(4);
  const Plane plane({1, 2, 3}, -1);
  const Vector3 along(1, 0, 0.2);
  const auto found = fit_mirror(on(plane, random, 50), "plane", along);
  EXPECT_EQ(found->kind(), "oblique plane");
  EXPECT_LT(off(*found, ObliquePlane(plane.normal(), plane.offset(), along),
                on(Sphere(Vector3::Zero(), 1), random, 50)),
            1e-12);
}

TEST(FitMirror, NamesWhatIsNotAllowed) {
  RandomCloud random(5);
  const Points plane = on(Plane({0, 0, 1}, 0), random, 50);
  expect_error<InvalidInput>("determine no sphere", [&] { fit_mirror(plane, "sphere"); });
  expect_error<InvalidInput>("at least 9",
                             [&] { fit_mirror(Points(plane.topRows(8)), "quadric"); });
  expect_error<InvalidInput>("leaves it", [&] { fit_mirror(plane, "plane", Vector3(1, 0, 0)); });
  expect_error<InvalidParameter>(
      "kind is 'cone'; allowed is auto, plane, sphere, cylinder, quadric, "
      "free-form",
      [&] { fit_mirror(plane, "cone"); });
  expect_error<InvalidParameter>("allowed is auto, plane, free-form with a direction",
                                 [&] { fit_mirror(plane, "sphere", Vector3(0, 0, 1)); });
}

}  // namespace
}  // namespace symsurf::fit_mirror_tests
