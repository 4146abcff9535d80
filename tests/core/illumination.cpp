// Light that a mirror throws onto points (the operation "illuminate").

#include <gtest/gtest.h>
#include <symsurf/mirrors.h>
#include <symsurf/operations.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "bumpy_ball.h"
#include "cloud/triangle_mesh.h"
#include "figure.h"
#include "random_cloud.h"

namespace symsurf::illumination_tests {
namespace {

constexpr double pi = std::numbers::pi;

TEST(Illuminate, OverAPlaneTheLightsImageShines) {
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    RandomCloud random(seed);
    const Plane plane(random.direction(), random.uniform(-1, 1));
    const Vector3 light = 2 * random.in_box(), image = plane.reflect(light);
    const Points points = 2 * random.box(100);
    const OperationResult lit = operate("illuminate", {points}, plane, {{"light", light}});
    double count = 0;
    for (Index i = 0; i < points.rows(); ++i) {
      const Vector3 x = points.row(i).transpose();
      const bool is_lit = (plane.signed_distance(x) > 0) == (plane.signed_distance(light) > 0);
      count += is_lit;
      EXPECT_EQ(lit.arrays.at("paths")(i, 0), is_lit);
      const double expected = is_lit ? 1 / (x - image).squaredNorm() : 0;
      EXPECT_NEAR(lit.arrays.at("irradiance")(i, 0), expected, 1e-9 * expected);
      const Vector3 at = lit.arrays.at("reflection").row(i).transpose();
      EXPECT_EQ(at.allFinite(), is_lit);
      if (is_lit) {
        EXPECT_NEAR(plane.signed_distance(at), 0, 1e-12);
        EXPECT_LE((at - x).cross(image - x).norm(), 1e-10);
      }
    }
    EXPECT_EQ(figure(lit, "lit_share"), count / 100);
  }
}

// A parallel beam, as bright as where it left the mirror: on a small screen as far away as one
// likes.
TEST(Illuminate, FromAParaboloidsFocusABeamIsThrown) {
  const double focus = 0.7;
  const Vector3 light(0, 0, focus);
  const Quadric bowl(Vector3(1, 1, 0).asDiagonal().toDenseMatrix(), Vector3(0, 0, -4 * focus), 0);
  RandomCloud random(1);
  Points screen = 0.02 * random.box(50);
  screen.rowwise() += Eigen::RowVector3d(0.6, -0.4, 30);
  const OperationResult lit = operate("illuminate", {screen}, bowl, {{"light", light}});
  EXPECT_EQ(std::get<Index>(lit.statistics.at("most_paths")), 1);
  EXPECT_EQ(figure(lit, "lit_share"), 1);
  for (Index i = 0; i < screen.rows(); ++i) {
    const double square = screen.row(i).head<2>().squaredNorm();
    const Vector3 at(screen(i, 0), screen(i, 1), square / (4 * focus));
    EXPECT_LE((lit.arrays.at("reflection").row(i).transpose() - at).norm(), 1e-9);
    EXPECT_NEAR(lit.arrays.at("irradiance")(i, 0) * (at - light).squaredNorm(), 1, 1e-9);
  }
}

// Both sides of a mesh are lit, so that what reaches a ball is twice its solid angle.
TEST(Illuminate, ABallGetsTheLightOfItsSolidAngle) {
  Ball b = ball(0);
  b.points.rowwise().normalize();
  const Plane plane(Vector3::UnitZ(), 2);
  const Vector3 light(0.5, 0, -1.5);
  const double distance = plane.reflect(light).norm();
  const OperationResult lit = operate("illuminate", {b.points, b.faces}, plane, {{"light", light}});
  const std::vector<double> areas = TriangleMesh(b.points, b.faces).vertex_areas();
  double sum = 0;
  for (Index i = 0; i < b.points.rows(); ++i) sum += areas[i] * lit.arrays.at("irradiance")(i, 0);
  const double expected = 4 * pi * (1 - std::sqrt(1 - 1 / (distance * distance)));
  EXPECT_NEAR(sum, expected, 0.01 * expected);  // the area of triangles is less than the ball's
}

// Alhazen's problem has up to four solutions within a sphere.
TEST(Illuminate, InAHollowSphereAllPathsCount) {
  RandomCloud random(2);
  const Points points = 0.6 * random.box(200);
  const Vector3 light(0.5, 0.2, -0.3);
  const Sphere sphere(Vector3::Zero(), 1);
  const OperationResult lit = operate("illuminate", {points}, sphere, {{"light", light}});
  EXPECT_EQ(std::get<Index>(lit.statistics.at("most_paths")), 4);
  EXPECT_EQ(lit.arrays.at("paths").minCoeff(), 2);
  for (Index i = 0; i < points.rows(); ++i) {
    const Vector3 x = points.row(i).transpose();
    const ReflectionPoints each = reflection_points(sphere, PointsView(x.data(), 1), light);
    EXPECT_EQ(lit.arrays.at("paths")(i, 0), each.positions.rows());
    EXPECT_NEAR(lit.arrays.at("irradiance")(i, 0) / each.irradiance.sum(), 1, 1e-12);
    EXPECT_EQ(lit.arrays.at("reflection").row(i), each.positions.row(0));
  }
}

}  // namespace
}  // namespace symsurf::illumination_tests
