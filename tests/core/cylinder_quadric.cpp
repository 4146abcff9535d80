#include <gtest/gtest.h>
#include <symsurf/context.h>
#include <symsurf/mirrors.h>

#include <Eigen/Geometry>

#include "expect_error.h"
#include "random_cloud.h"

namespace symsurf::cylinder_quadric_tests {
namespace {

TEST(Cylinder, MirrorsAlongTheRadius) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    RandomCloud random(seed);
    const Vector3 point = random.in_box(), axis = random.direction();
    const double radius = random.uniform(0.2, 2);
    const Cylinder cylinder(point, 3 * axis, radius);
    const Vector3 u = axis.cross(random.direction()).normalized();
    const double distance = random.uniform(0.01, 1.99) * radius, along = random.uniform(-5, 5);
    const Vector3 x = point + along * axis + distance * u;
    EXPECT_NEAR((cylinder.foot(x) - (point + along * axis + radius * u)).norm(), 0, 1e-13);
    EXPECT_NEAR((cylinder.reflect(cylinder.reflect(x)) - x).norm(), 0, 1e-12);
    EXPECT_NEAR(cylinder.signed_distance(x), distance - radius, 1e-13);
    EXPECT_TRUE(cylinder.reflect(Vector3(point + 2.001 * radius * u)).hasNaN());
    const Matrix3 rotation = random.rotation();
    const Vector3 shift = random.in_box();
    const auto moved = cylinder.transformed(2, rotation, shift);
    const Vector3 expected = 2 * (rotation * cylinder.reflect(x)) + shift;
    EXPECT_NEAR((moved->reflect(Vector3(2 * (rotation * x) + shift)) - expected).norm(), 0, 1e-12);
    const Vector3 again = make_mirror("cylinder", cylinder.numbers())->reflect(x);
    EXPECT_NEAR((again - cylinder.reflect(x)).norm(), 0, 1e-13);
  }
}

TEST(Cylinder, RefusesWhatIsNoCylinder) {
  expect_error<InvalidInput>("cylinder needs", [] { Cylinder({0, 0, 0}, {0, 0, 0}, 1); });
  expect_error<InvalidInput>("cylinder needs", [] { Cylinder({0, 0, 0}, {0, 0, 1}, 0); });
}

TEST(Cylinder, MeshLiesOnIt) {
  const Cylinder cylinder({1, 0, 0}, {0, 0, 1}, 2);
  const Mesh mesh = cylinder.mesh(RandomCloud(0).box(100), 16);
  ASSERT_GT(mesh.triangles.rows(), 0);
  for (Index v = 0; v < mesh.vertices.rows(); ++v)
    EXPECT_NEAR(cylinder.signed_distance(Vector3(mesh.vertices.row(v))), 0, 1e-13);
}

// x'x - r^2 about a centre is a sphere, whatever the scale of the coefficients.
TEST(Quadric, OfASphereMirrorsAsTheSphereDoes) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    RandomCloud random(seed);
    const Vector3 c = random.in_box();
    const double r = random.uniform(0.5, 2), k = random.uniform(0.1, 10);
    const Quadric quadric(k * Matrix3::Identity(), -2 * k * c, k * (c.squaredNorm() - r * r));
    const Sphere sphere(c, r);
    for (int i = 0; i < 50; ++i) {
      const Vector3 x = c + random.uniform(0.05, 1.95) * r * random.direction();
      EXPECT_NEAR((quadric.reflect(x) - sphere.reflect(x)).norm(), 0, 1e-9);
      EXPECT_NEAR(quadric.signed_distance(x), sphere.signed_distance(x), 1e-9);
    }
  }
}

TEST(Quadric, FootIsTheClosestPoint) {
  int without = 0;
  for (std::uint64_t seed = 0; seed < 5 * seeds; ++seed) {
    RandomCloud random(seed);
    Matrix3 a;
    for (int i = 0; i < 3; ++i) a.row(i) = random.in_box().transpose();
    const Quadric quadric(a, random.in_box(), random.uniform(-1, 1));
    const Vector3 x = random.in_box(), foot = quadric.foot(x);
    if (foot.hasNaN()) {
      ++without;
      continue;
    }
    EXPECT_NEAR(quadric.value(foot), 0, 1e-8);
    EXPECT_NEAR(quadric.gradient(foot).normalized().cross(x - foot).norm(), 0, 1e-7);
    // Nothing of the surface is nearer: f keeps its sign in the ball around x up to the foot.
    const double reach = (x - foot).norm();
    for (int i = 0; i < 200; ++i) {
      const Vector3 inside = x + 0.999 * reach * random.direction();
      EXPECT_GT(quadric.value(inside) * quadric.value(x), -1e-12);
    }
  }
  EXPECT_LT(without, seeds);  // a fifth: few of them have no real point
}

TEST(Quadric, IsAsExactFarFromTheOrigin) {
  Matrix3 a = Matrix3::Identity();
  a(2, 2) = 0.3;
  const Quadric quadric(a, {0.1, 0.2, 0}, -1);
  RandomCloud random(1);
  for (const double away : {1e4, 1e6, 1e8}) {
    const Vector3 shift = away * random.direction(), x(0.1, 0.15, 1.2);
    const auto moved = quadric.transformed(1, Matrix3::Identity(), shift);
    EXPECT_LE((moved->reflect(x + shift) - (quadric.reflect(x) + shift)).norm(), 1e-14 * away);
    const auto copy = make_mirror("quadric", moved->numbers());
    EXPECT_EQ(copy->reflect(Vector3(x + shift)), moved->reflect(Vector3(x + shift)));
  }
}

TEST(Quadric, MovesWithItsPointsAndComesBackFromItsNumbers) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    RandomCloud random(seed);
    Matrix3 a = Matrix3::Identity();
    a(2, 2) = 0.3;
    const Quadric quadric(a, 0.2 * random.in_box(), -1);
    const Matrix3 rotation = random.rotation();
    const Vector3 shift = random.in_box(), x = random.in_box() + Vector3(0, 0, 2);
    const auto moved = quadric.transformed(3, rotation, shift);
    const Vector3 expected = 3 * (rotation * quadric.reflect(x)) + shift;
    EXPECT_NEAR((moved->reflect(Vector3(3 * (rotation * x) + shift)) - expected).norm(), 0, 1e-8);
    EXPECT_EQ(make_mirror("quadric", quadric.numbers())->reflect(x), quadric.reflect(x));
  }
}

TEST(Quadric, MeshLiesOnIt) {
  const Quadric quadric(Vector3(1, 0.25, 1. / 9).asDiagonal(), {0, 0, 0}, -1);
  const Points object = 2 * RandomCloud(0).sphere(500);
  const Mesh mesh = quadric.mesh(object, 12);
  ASSERT_GT(mesh.vertices.rows(), 100);
  for (Index v = 0; v < mesh.vertices.rows(); ++v)
    EXPECT_NEAR(quadric.value(mesh.vertices.row(v)), 0, 1e-12);
}

TEST(Quadric, RefusesWhatIsNoSurface) {
  expect_error<InvalidInput>("quadric needs", [] { Quadric(Matrix3::Zero(), {0, 0, 0}, 1); });
}

}  // namespace
}  // namespace symsurf::cylinder_quadric_tests
