#include <gtest/gtest.h>
#include <symsurf/detect.h>
#include <symsurf/mirrors.h>

#include <cmath>
#include <numbers>

#include "bumpy_ball.h"
#include "expect_error.h"
#include "random_cloud.h"

namespace symsurf::oblique_plane_tests {
namespace {

constexpr double degree = std::numbers::pi / 180;

// y grows with x: x = 0 mirrors along (1, tan angle, 0) what it mirrored along x.
Points sheared(Points points, double angle) {
  points.col(1) += std::tan(angle) * points.col(0);
  return points;
}

// Of a body whose mirror is the plane x = 0: how far images over the mirror are from the true ones.
double off(const Mirror& mirror, const Points& body, double angle) {
  Points images = body;
  images.col(0) *= -1;
  const Points sheared_body = sheared(body, angle);
  return (mirror.reflect(PointsView(sheared_body)) - sheared(images, angle))
      .rowwise()
      .norm()
      .maxCoeff();
}

TEST(ObliquePlane, MapsAlongItsDirection) {
  const ObliquePlane plane({0, 0, 2}, -1, {0, -3, -3});
  EXPECT_LT((plane.direction() - Vector3(0, 1, 1).normalized()).norm(), 1e-15);
  EXPECT_NEAR(plane.obliquity(), 45 * degree, 1e-14);
  const Vector3 x(1, 2, 3), image(1, -3, -2);
  EXPECT_LT((plane.reflect(x) - image).norm(), 1e-14);
  EXPECT_LT((plane.reflect(image) - x).norm(), 1e-14);
  EXPECT_LT(((plane.matrix() * x.homogeneous()).head<3>() - image).norm(), 1e-14);
  const Foot foot = *plane.at(x);
  EXPECT_LT((foot.point + foot.distance * plane.direction(foot) - x).norm(), 1e-14);
}

TEST(ObliquePlane, RefusesADirectionWithinIt) {
  expect_error<InvalidInput>("a direction that leaves it", [] {
    ObliquePlane({1, 0, 0}, 0, {0, 1, 0});
  });
  expect_error<InvalidInput>("a direction that leaves it", [] {
    ObliquePlane({1, 0, 0}, 0, {0, 0, 0});
  });
}

TEST(ObliquePlane, IsFoundExactlyWhereThePairsAre) {
  for (std::uint64_t seed = 0; seed < slow_seeds; ++seed) {
    SCOPED_TRACE(seed);
    RandomCloud random(seed);
    const double angle = random.uniform(3, 45) * degree;
    const Points body = ball(seed).points, given = sheared(body, angle);
    for (const char* method : {"oblique_plane", "auto"}) {
      const Result result = detect(given, {.method = method});
      ASSERT_TRUE(result.mirror);
      EXPECT_EQ(result.mirror->kind(), "oblique plane");
      EXPECT_EQ(result.verdict(), "found");
      EXPECT_LT(off(*result.mirror, body, angle), 1e-9);
    }
  }
}

TEST(ObliquePlane, IsAPlaneOfAStraightBody) {
  for (std::uint64_t seed = 0; seed < slow_seeds; ++seed) {
    SCOPED_TRACE(seed);
    const Points body = ball(seed).points;
    const Result oblique = detect(body, {.method = "oblique_plane"});
    ASSERT_TRUE(oblique.mirror);
    EXPECT_LT(off(*oblique.mirror, body, 0), 1e-9);
    EXPECT_EQ(detect(body, {.method = "auto"}).mirror->kind(), "plane");
  }
}

TEST(ObliquePlane, IsStraightenedByUndoingTheShear) {
  const double angle = 30 * degree;
  const Points body = ball(1).points, given = sheared(body, angle);
  const ObliquePlane mirror({1, 0, 0}, 0, {1, std::tan(angle), 0});
  const Points straight = bend(PointsView(given), mirror, Bend::Straighten);
  // Rigidly moved: all points are as far from each other as they were.
  for (Index i = 1; i < body.rows(); ++i)
    EXPECT_NEAR((straight.row(i) - straight.row(0)).norm(), (body.row(i) - body.row(0)).norm(),
                1e-12);
  ObliquePlane placed = mirror;
  placed.set_footprint(std::make_shared<const Points>(given));
  EXPECT_LT((bend(PointsView(straight), placed, Bend::Restore) - given).rowwise().norm().maxCoeff(),
            1e-12);
}

}  // namespace
}  // namespace symsurf::oblique_plane_tests
