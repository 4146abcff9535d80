#include <gtest/gtest.h>
#include <symsurf/context.h>
#include <symsurf/mirrors.h>

#include <Eigen/Geometry>
#include <cmath>
#include <vector>

#include "expect_error.h"
#include "mesh_area.h"
#include "random_cloud.h"

namespace symsurf::free_form_tests {
namespace {

// The cap of the unit sphere about z as patches: each the sphere's own osculating paraboloid.
std::vector<Patch> unit_cap(double opening, double apart) {
  std::vector<Patch> patches;
  const int rings = static_cast<int>(opening / apart);
  for (int r = 0; r <= rings; ++r) {
    const double polar = r * apart;
    const int around =
        std::max(1, static_cast<int>(std::round(2 * M_PI * std::sin(polar) / apart)));
    for (int k = 0; k < around; ++k) {
      const double angle = 2 * M_PI * k / around;
      Patch p;
      p.centre = {std::sin(polar) * std::cos(angle), std::sin(polar) * std::sin(angle),
                  std::cos(polar)};
      p.frame.row(2) = p.centre.transpose();
      p.frame.row(0) = p.centre.unitOrthogonal().transpose();
      p.frame.row(1) = p.frame.row(2).cross(p.frame.row(0));
      p.height << 0, 0, 0, -0.5, 0, -0.5;
      p.radius = 2.5 * apart;
      patches.push_back(p);
    }
  }
  return patches;
}

TEST(FreeForm, FootIsTheClosestPointAndReflectionAnInvolution) {
  const FreeForm cap(unit_cap(0.8, 0.05));
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    RandomCloud random(seed);
    const double polar = random.uniform(0, 0.6), angle = random.uniform(0, 6.28);
    const Vector3 u(std::sin(polar) * std::cos(angle), std::sin(polar) * std::sin(angle),
                    std::cos(polar));
    const double radius = random.uniform(0.6, 1.4);
    const Vector3 x = radius * u;
    // A paraboloid leaves its sphere by r^4 / 8 at the patch's rim.
    EXPECT_NEAR(cap.signed_distance(x), radius - 1, 1e-4);
    EXPECT_NEAR((cap.foot(x) - u).norm(), 0, 2e-3);
    EXPECT_NEAR((cap.reflect(cap.reflect(x)) - x).norm(), 0, 1e-10);
    EXPECT_NEAR(cap.signed_distance(cap.foot(x)), 0, 1e-12);
  }
}

TEST(FreeForm, HasNoFootBeyondItsPatches) {
  const FreeForm cap(unit_cap(0.5, 0.05));
  EXPECT_TRUE(cap.foot(Vector3(1.2, 0, 0)).hasNaN());
  EXPECT_TRUE(cap.reflect(Vector3(0, 0, -1)).hasNaN());
  EXPECT_TRUE(std::isnan(cap.signed_distance(Vector3(0, 1.1, 0))));
}

TEST(FreeForm, MovesWithItsPointsAndComesBackFromItsNumbers) {
  const FreeForm cap(unit_cap(0.6, 0.06));
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    RandomCloud random(seed);
    const Matrix3 rotation = random.rotation();
    const Vector3 shift = 10 * random.in_box();
    const Vector3 x = Vector3(0.1, 0.1, 1.1) + 0.2 * random.in_box();
    const auto moved = cap.transformed(3, rotation, shift);
    EXPECT_NEAR(
        (moved->reflect(3 * rotation * x + shift) - (3 * rotation * cap.reflect(x) + shift)).norm(),
        0, 1e-11);
    EXPECT_EQ(make_mirror("free-form", cap.numbers())->reflect(x), cap.reflect(x));
  }
}

TEST(FreeForm, IsAsExactFarFromTheOrigin) {
  const FreeForm cap(unit_cap(0.6, 0.06));
  RandomCloud random(1);
  for (const double away : {1e4, 1e6, 1e8}) {
    const Vector3 shift = away * random.direction(), x(0.1, 0.15, 1.2);
    const auto moved = cap.transformed(1, Matrix3::Identity(), shift);
    EXPECT_LE((moved->reflect(x + shift) - (cap.reflect(x) + shift)).norm(), 1e-14 * away);
  }
}

TEST(FreeForm, MeshLiesOnTheMirrorAndCoversTheObject) {
  const FreeForm cap(unit_cap(0.6, 0.05));
  Points object(400, 3);
  RandomCloud random(1);
  for (Index i = 0; i < object.rows(); ++i) {
    const Vector3 u = Vector3(random.uniform(-0.4, 0.4), random.uniform(-0.4, 0.4), 1).normalized();
    object.row(i) = (random.uniform(0.8, 1.2) * u).transpose();
  }
  const Mesh mesh = cap.mesh(object, 24);
  ASSERT_GT(mesh.triangles.rows(), 100);
  for (Index v = 0; v < mesh.vertices.rows(); ++v)
    EXPECT_NEAR(mesh.vertices.row(v).norm(), 1, 2e-3);
  // But for a few at its rim, which have no foot.
  const Eigen::ArrayXd off = cap.signed_distance(PointsView(mesh.vertices)).array().abs();
  EXPECT_GT((off < 1e-9).count(), 0.8 * off.size());
  const Points feet = cap.project(object);
  for (Index i = 0; i < feet.rows(); ++i) {
    const double nearest = (mesh.vertices.rowwise() - feet.row(i)).rowwise().norm().minCoeff();
    EXPECT_LT(nearest, 0.06);
  }
}

// About random positions of the cap, a point on either side of each.
Points about_the_cap(double opening, double width, RandomCloud& random) {
  constexpr Index positions = 1500;
  Points object(2 * positions, 3);
  for (Index i = 0; i < positions; ++i) {
    const double x = random.uniform(-opening, opening), y = random.uniform(-width, width);
    const Vector3 foot = Vector3(std::sin(x), y, std::cos(x)).normalized();
    object.row(2 * i) = 1.1 * foot.transpose();
    object.row(2 * i + 1) = 0.9 * foot.transpose();
  }
  return object;
}

TEST(FreeForm, MeshHasNoGapsHoweverFine) {
  RandomCloud random(1);
  const FreeForm cap(unit_cap(0.8, 0.05));
  const Points object = about_the_cap(0.5, 0.4, random);
  const double fine = area(cap.mesh(object, 64));
  EXPECT_NEAR(area(cap.mesh(object, 128)), fine, 0.05 * fine);
  EXPECT_NEAR(area(cap.mesh(object, 256)), fine, 0.05 * fine);
}

// Cells of a thirty-second of the length stick out of what patches reach.
TEST(FreeForm, MeshOfANarrowMirrorIsWhole) {
  RandomCloud random(2);
  std::vector<Patch> strip = unit_cap(0.8, 0.01);
  std::erase_if(strip, [](const Patch& patch) { return std::abs(patch.centre.y()) > 0.02; });
  const FreeForm mirror(strip);
  const Points object = about_the_cap(0.7, 0.015, random);
  const Mesh mesh = mirror.mesh(object);
  ASSERT_GT(mesh.triangles.rows(), 0);
  const Points feet = mirror.project(object);
  for (Index i = 0; i < feet.rows(); ++i) {
    const double nearest = (mesh.vertices.rowwise() - feet.row(i)).rowwise().norm().minCoeff();
    EXPECT_LT(nearest, 1.5 * 1.4 / 32);
  }
}

TEST(FreeForm, RefusesWhatIsNoSurface) {
  expect_error<InvalidInput>("at least one patch", [] { FreeForm({}); });
  auto patches = unit_cap(0.2, 0.05);
  patches[3].radius = 0;
  expect_error<InvalidInput>("patch 3", [&] { FreeForm{patches}; });
  patches[3].radius = 0.1;
  patches[3].frame.row(0) *= 2;
  expect_error<InvalidInput>("patch 3", [&] { FreeForm{patches}; });
}

}  // namespace
}  // namespace symsurf::free_form_tests
