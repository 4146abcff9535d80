#include <gtest/gtest.h>
#include <symsurf/context.h>
#include <symsurf/mirrors.h>

#include <Eigen/Dense>
#include <cmath>
#include <limits>
#include <memory>

#include "expect_error.h"
#include "mesh_area.h"
#include "random_cloud.h"

namespace symsurf::mirror_tests {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

Plane random_plane(RandomCloud& random) {
  return Plane(random.direction() * random.uniform(0.1, 10), random.uniform(-2, 2));
}

TEST(Plane, ReflectedTwiceIsThePoint) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    RandomCloud random(seed);
    const Plane plane = random_plane(random);
    const Points points = random.box(100), images = plane.reflect(points);
    EXPECT_LE((plane.reflect(images) - points).cwiseAbs().maxCoeff(), 1e-13);
    EXPECT_LE((plane.signed_distance(images) + plane.signed_distance(points)).cwiseAbs().maxCoeff(),
              1e-13);
  }
}

TEST(Plane, HasItsPointsBetweenThePointsAndTheirImages) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    RandomCloud random(seed);
    const Plane plane = random_plane(random);
    const Points points = random.box(100), feet = plane.project(points);
    EXPECT_LE((feet - (points + plane.reflect(points)) / 2).cwiseAbs().maxCoeff(), 1e-13);
    EXPECT_LE(((feet * plane.normal()).array() + plane.offset()).abs().maxCoeff(), 1e-13);
    const Points chords = points - feet;
    EXPECT_LE(chords.rowwise().cross(plane.normal()).cwiseAbs().maxCoeff(), 1e-13);
    EXPECT_LE((chords * plane.normal() - plane.signed_distance(points)).cwiseAbs().maxCoeff(),
              1e-13);
  }
}

TEST(Plane, MatrixDoesWhatReflectDoes) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    RandomCloud random(seed);
    const Plane plane = random_plane(random);
    const Matrix4 matrix = plane.matrix();
    for (int i = 0; i < 100; ++i) {
      const Vector3 x = random.in_box();
      const Eigen::Vector4d image = matrix * x.homogeneous();
      EXPECT_LE((image.head<3>() - plane.reflect(x)).norm(), 1e-13);
      EXPECT_EQ(image[3], 1);
    }
    EXPECT_NEAR(matrix.determinant(), -1, 1e-12);
  }
}

TEST(Plane, MovesWithTheSpace) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    RandomCloud random(seed);
    const Plane plane = random_plane(random);
    const Matrix3 rotation = random.rotation();
    const Vector3 translation = 100 * random.in_box();
    const double scale = random.uniform(0.01, 100);
    const auto moved = [&](const Vector3& x) -> Vector3 {
      return scale * (rotation * x) + translation;
    };
    const std::unique_ptr<Mirror> mirror = plane.transformed(scale, rotation, translation);
    EXPECT_EQ(mirror->kind(), "plane");
    for (int i = 0; i < 100; ++i) {
      const Vector3 x = random.in_box();
      EXPECT_LE((mirror->reflect(moved(x)) - moved(plane.reflect(x))).norm(), 1e-10);
      EXPECT_NEAR(mirror->signed_distance(moved(x)), scale * plane.signed_distance(x), 1e-10);
    }
  }
}

TEST(Plane, KnowsItsNumbers) {
  const Plane plane({0, 0, 4}, -8);
  EXPECT_EQ(plane.normal(), Vector3(0, 0, 1));
  EXPECT_EQ(plane.offset(), -2);
  EXPECT_EQ(plane.foot({1, 2, 5}), Vector3(1, 2, 2));
  EXPECT_EQ(plane.signed_distance({1, 2, 5}), 3);
  EXPECT_EQ(plane.reflect({1, 2, 5}), Vector3(1, 2, -1));
  EXPECT_EQ(plane.numbers(), (Values{{"normal", Vector3(0, 0, 1)}, {"offset", -2.0}}));
}

TEST(Plane, HasAFrame) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    RandomCloud random(seed);
    const Plane plane = random_plane(random);
    const Matrix3 axes = plane.axes();
    EXPECT_LE((axes * axes.transpose() - Matrix3::Identity()).norm(), 1e-14);
    EXPECT_NEAR(axes.determinant(), 1, 1e-14);
    EXPECT_EQ(axes.row(2).transpose(), plane.normal());
    Index least;
    plane.normal().cwiseAbs().minCoeff(&least);
    EXPECT_EQ(axes(0, least), 0);
    EXPECT_LE(std::abs(plane.signed_distance(plane.origin())), 1e-13);
    EXPECT_LE(plane.origin().cross(plane.normal()).norm(), 1e-13);
  }
}

TEST(Mirror, IsEqualToTheLastBit) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    RandomCloud random(seed);
    const Plane plane = random_plane(random);
    Plane same(plane.normal(), plane.offset());
    same.set_footprint(std::make_shared<Points>(random.box(3)));
    EXPECT_TRUE(plane == same);
    EXPECT_FALSE(plane == Plane(plane.normal(), std::nextafter(plane.offset(), infinity)));
    EXPECT_FALSE(plane == Sphere(plane.normal(), 1));
  }
  // Tables of other sizes are no error.
  const HeightField three(Vector3::UnitZ(), Points::Identity(3, 3)),
      two(Vector3::UnitZ(), Points::Identity(2, 3));
  EXPECT_TRUE(three == three);
  EXPECT_FALSE(three == two);
}

TEST(Plane, NeedsANormal) {
  const double nan = std::nan("");
  expect_error<InvalidInput>("(0, 0, 0)", [] { Plane({0, 0, 0}, 1); });
  for (const double bad : {nan, infinity}) {
    EXPECT_THROW(Plane({bad, 0, 0}, 1), InvalidInput);
    EXPECT_THROW(Plane({1, 0, 0}, bad), InvalidInput);
  }
}

// Whether x, on the plane, is in the triangle or no farther out than rounding.
bool is_in(const Mesh& mesh, Index triangle, const Vector3& x) {
  const auto corner = [&](int c) -> Vector3 {
    return mesh.vertices.row(mesh.triangles(triangle, c));
  };
  Eigen::Matrix<double, 3, 2> edges;
  edges << corner(1) - corner(0), corner(2) - corner(0);
  const Eigen::Vector2d at = edges.colPivHouseholderQr().solve(x - corner(0));
  return at.minCoeff() >= -1e-9 && at.sum() <= 1 + 1e-9;
}

TEST(PlaneMesh, CoversTheFootprint) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    RandomCloud random(seed);
    const Plane plane = random_plane(random);
    const Points points = random.box(200) * Vector3(1, 2, 5).asDiagonal();
    const Mesh mesh = plane.mesh(points, 6);
    EXPECT_LE(plane.signed_distance(mesh.vertices).cwiseAbs().maxCoeff(), 1e-12);
    ASSERT_GE(mesh.triangles.minCoeff(), 0);
    ASSERT_LT(mesh.triangles.maxCoeff(), mesh.vertices.rows());
    const Points feet = plane.project(points);
    for (Index i = 0; i < feet.rows(); ++i) {
      bool covered = false;
      for (Index t = 0; t < mesh.triangles.rows() && !covered; ++t)
        covered = is_in(mesh, t, feet.row(i));
      EXPECT_TRUE(covered) << "point " << i;
    }
    const double diagonal = 2 * Vector3(1, 2, 5).norm();
    EXPECT_LE(area(mesh), diagonal * diagonal);
  }
}

TEST(PlaneMesh, HasItsResolutionAlongTheLongerSide) {
  Points points(4, 3);
  points << 0, 0, 0, 8, 0, 1, 8, 4, 0, 0, 4, 1;
  const Mesh mesh = Plane({0, 0, 1}, 0).mesh(points, 8);
  EXPECT_EQ(mesh.triangles.rows(), 8 * 4 * 2);
  EXPECT_EQ(mesh.vertices.rows(), 9 * 5);
  EXPECT_NEAR(area(mesh), 32, 1e-12);
}

TEST(PlaneMesh, SaysWhatIsWrong) {
  const Plane plane({0, 0, 1}, 0);
  expect_error<InvalidInput>("no footprint", [&] { plane.mesh(); });
  const Points points = RandomCloud(0).box(10);
  expect_error<InvalidParameter>("resolution is 0; allowed is 1 to 4096",
                                 [&] { plane.mesh(points, 0); });
  Points broken = points;
  broken(3, 1) = std::nan("");
  expect_error<InvalidInput>("point 3", [&] { plane.mesh(broken); });
}

// The search for the closest point went on for hours. Found by fuzzing.
TEST(SurfaceMirror, HasFeetOfPointsFarAway) {
  for (const char* name : {"f1", "f2", "f3", "f4", "f5", "f6"}) {
    const SurfaceMirror mirror(surface(name), Mapping::Perpendicular);
    for (const double far : {1e3, 6.2387e11, -3e14})
      EXPECT_TRUE(mirror.foot(Vector3(far, 0.7 * far, 0.1 * far)).allFinite()) << name << far;
    mirror.foot(Vector3(1, -1e308, 1));  // whose distance is no double
  }
}

}  // namespace
}  // namespace symsurf::mirror_tests
