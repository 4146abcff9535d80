#include <gtest/gtest.h>
#include <symsurf/context.h>
#include <symsurf/mirrors.h>

#include <Eigen/Geometry>
#include <cmath>

#include "expect_error.h"
#include "random_cloud.h"

namespace symsurf::sphere_tests {
namespace {

TEST(Sphere, MirrorsAlongTheRadius) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    RandomCloud random(seed);
    const Vector3 centre = random.in_box();
    const double radius = random.uniform(0.2, 2);
    const Sphere sphere(centre, radius);
    const Vector3 u = random.direction();
    const double distance = random.uniform(0.01, 1.99) * radius;
    const Vector3 x = centre + distance * u;

    const Vector3 image = sphere.reflect(x);
    EXPECT_NEAR((image - (centre + (2 * radius - distance) * u)).norm(), 0, 1e-14);
    EXPECT_NEAR((sphere.reflect(image) - x).norm(), 0, 1e-14);
    EXPECT_NEAR((sphere.foot(x) - (centre + radius * u)).norm(), 0, 1e-14);
    EXPECT_NEAR(sphere.signed_distance(x), distance - radius, 1e-14);
    EXPECT_NEAR((sphere.foot(x) - (x + image) / 2).norm(), 0, 1e-14);
  }
}

TEST(Sphere, HasNoImageBeyondTwiceTheRadiusNorAtTheCentre) {
  const Sphere sphere(Vector3(1, 2, 3), 0.5);
  EXPECT_TRUE(sphere.reflect(Vector3(2.001, 2, 3)).hasNaN());
  EXPECT_EQ(sphere.reflect(Vector3(2, 2, 3)), Vector3(1, 2, 3));
  EXPECT_EQ(sphere.foot(Vector3(5, 2, 3)), Vector3(1.5, 2, 3));
  EXPECT_TRUE(sphere.reflect(Vector3(1, 2, 3)).hasNaN());
  EXPECT_TRUE(sphere.foot(Vector3(1, 2, 3)).hasNaN());
  EXPECT_TRUE(std::isnan(sphere.signed_distance(Vector3(1, 2, 3))));
}

TEST(Sphere, MovesWithItsPoints) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    RandomCloud random(seed);
    const Sphere sphere(random.in_box(), 1.5);
    const Matrix3 rotation = random.rotation();
    const Vector3 shift = 10 * random.in_box(), x = random.in_box();
    const auto moved = sphere.transformed(2, rotation, shift);
    const Vector3 expected = 2 * rotation * sphere.reflect(x) + shift;
    EXPECT_NEAR((moved->reflect(2 * rotation * x + shift) - expected).norm(), 0, 1e-13);
  }
}

TEST(Sphere, MeshesTheCapOverItsObject) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    RandomCloud random(seed);
    const Vector3 centre = random.in_box(), pole = random.direction();
    const Sphere sphere(centre, 2);
    Points object(300, 3);
    for (Index i = 0; i < object.rows(); ++i)
      object.row(i) = (centre + 2 * (pole + 0.4 * random.in_box())).transpose();
    const Mesh mesh = sphere.mesh(object, 24);
    for (const auto& v : mesh.vertices.rowwise())
      EXPECT_NEAR((v.transpose() - centre).norm(), 2, 1e-13);
    // Every foot has the mesh near it, and the mesh does not go all around.
    double cell = 0;
    for (Index t = 0; t < mesh.triangles.rows(); ++t)
      cell = std::max(
          cell, (mesh.vertices.row(mesh.triangles(t, 0)) - mesh.vertices.row(mesh.triangles(t, 1)))
                    .norm());
    const Points feet = sphere.project(object);
    for (const auto& foot : feet.rowwise())
      EXPECT_LT((mesh.vertices.rowwise() - foot).rowwise().norm().minCoeff(), cell);
    EXPECT_GT(((mesh.vertices.rowwise() - centre.transpose()) * pole).minCoeff(), 0);
  }
}

TEST(Sphere, MeshesTheWholeSphereWithoutEmptyTriangles) {
  RandomCloud random(1);
  const Mesh mesh = Sphere(Vector3::Zero(), 1).mesh(random.sphere(500), 40);
  double area = 0;
  for (Index t = 0; t < mesh.triangles.rows(); ++t) {
    const Vector3 a = mesh.vertices.row(mesh.triangles(t, 0));
    const Vector3 b = mesh.vertices.row(mesh.triangles(t, 1));
    const Vector3 c = mesh.vertices.row(mesh.triangles(t, 2));
    const double part = (b - a).cross(c - a).norm() / 2;
    EXPECT_GT(part, 0);
    area += part;
  }
  EXPECT_NEAR(area, 4 * M_PI, 0.1);
}

TEST(Sphere, RefusesWhatIsNoSphere) {
  for (const double radius : {0.0, -1.0, std::nan(""), std::numeric_limits<double>::infinity()})
    expect_error<InvalidInput>("radius above 0", [&] { Sphere(Vector3::Zero(), radius); });
  expect_error<InvalidInput>("finite centre", [] { Sphere(Vector3(0, NAN, 0), 1); });
  Points far(1, 3);
  far << 9, 9, 9;
  expect_error<InvalidInput>("image", [&] { Sphere(Vector3::Zero(), 1).mesh(far, 8); });
}

}  // namespace
}  // namespace symsurf::sphere_tests
