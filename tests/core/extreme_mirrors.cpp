// Mirrors and points at the ends of what doubles hold. Found by fuzzing: a mesh grew until memory
// ended, and searches went on for minutes.

#include <gtest/gtest.h>
#include <symsurf/symsurf.h>

#include <Eigen/Core>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "expect_error.h"
#include "random_cloud.h"

namespace symsurf::extreme_mirrors_tests {
namespace {

constexpr double largest = std::numeric_limits<double>::max();

// One of each kind, `size` input units large and as far from the origin.
std::vector<std::shared_ptr<Mirror>> mirrors_of_size(double size) {
  RandomCloud random(1);
  Patch patch;
  patch.centre = Vector3::Constant(size);
  patch.frame = Matrix3::Identity();
  patch.height = Eigen::Matrix<double, 6, 1>::Zero();
  patch.radius = size;
  Matrix3 bowl = Matrix3::Zero();
  bowl.diagonal().head<2>().setConstant(1 / size);
  return {std::make_shared<Plane>(Vector3(1, 2, 3), size),
          std::make_shared<Sphere>(Vector3::Constant(size), size),
          std::make_shared<Cylinder>(Vector3::Constant(size), Vector3(1, 2, 3), size),
          std::make_shared<Quadric>(bowl, -Vector3::UnitZ(), size),
          std::make_shared<FreeForm>(std::vector<Patch>{patch}),
          std::make_shared<HeightField>(Vector3::UnitZ(), Points(size * random.box(30))),
          std::make_shared<SurfaceMirror>(surface("f3"), Mapping::Perpendicular, size,
                                          Matrix3::Identity(), Vector3::Constant(size)),
          std::make_shared<SurfaceMirror>(surface("f2"), Mapping::Fixed, size, Matrix3::Identity(),
                                          Vector3::Constant(size))};
}

// A result or a named error, in the time that the test has.
void do_everything(const Mirror& mirror, const Points& points) {
  mirror.reflect(points);
  mirror.signed_distance(points);
  const auto attempt = [](const auto& call) {
    try {
      call();
    } catch (const InvalidInput&) {
    }
  };
  attempt([&] {
    const Mesh mesh = mirror.mesh(points, 8);
    EXPECT_TRUE(mesh.vertices.allFinite()) << mirror.kind();
  });
  for (const Bend way : {Bend::Straighten, Bend::Restore})
    attempt([&] { EXPECT_EQ(bend(points, mirror, way).rows(), points.rows()); });
  attempt([&] { straight_mirror(mirror, points); });
}

TEST(ExtremeMirrors, EndWithPointsOfAnySize) {
  const Points box = RandomCloud(2).box(20);
  for (const double size : {1e-150, 1.0, 1e150})
    for (const auto& mirror : mirrors_of_size(size))
      for (const double scale : {1e-300, 1.0, 1e50, 3e108, 1e300})
        do_everything(*mirror, scale * box);
}

TEST(ExtremeMirrors, HaveNoMeshBeyondTheLimit) {
  const Quadric quadric(Vector3(1, 1, -1).asDiagonal(), Vector3(0, 0, 1), 0);
  const Points box = RandomCloud(2).box(20);
  for (const double far : {1.1e50, 3e108, 0.4 * largest})
    expect_error<InvalidInput>("allowed is up to 1e+50", [&] { quadric.mesh(Points(far * box)); });
  // The points of a ball's middle have their feet all over the sphere around it.
  const Quadric ball(Matrix3::Identity(), Vector3::Zero(), -1e102);
  expect_error<InvalidInput>("the feet on the mirror extend over",
                             [&] { ball.mesh(Points(1e46 * box)); });
  EXPECT_GT(quadric.mesh(Points(1e49 * box)).triangles.rows(), 0);
  EXPECT_GT(Plane({0, 0, 1}, 1e60).mesh(box).triangles.rows(), 0);
}

// Where a cell of the net is less than the rounding of coordinates, all cells seemed near the feet.
TEST(ExtremeMirrors, HaveAMeshFarFromTheOrigin) {
  const Points box = RandomCloud(2).box(20);
  Patch patch;
  patch.frame = RandomCloud(3).rotation();
  patch.height << -0.9, -1.9, 0.1, 1.5, 1.5, -1.3;
  patch.radius = 0.2;
  for (const double far : {1e20, 1e60, 1e300}) {
    patch.centre = Vector3(-0.4, -1.6, far);
    do_everything(FreeForm({patch}), box);
  }
}

TEST(ExtremeMirrors, MatchNoPointsBeyondTheLimit) {
  Points points = RandomCloud(2).box(60);
  points.col(2).setConstant(largest);  // they extend over 2
  expect_error<InvalidInput>("point 0 is", [&] { match(points, Plane({1, 0, 0}, 0)); });
  for (const Method& method : methods())
    expect_error<InvalidInput>("allowed are coordinates up to 1e+50",
                               [&] { detect(points, {.method = method.name}); });
}

TEST(ExtremeMirrors, HaveAFinestMesh) {
  const Points box = RandomCloud(2).box(20);
  expect_error<InvalidParameter>("resolution is 2147483647; allowed is 1 to 4096", [&] {
    Plane({0, 0, 1}, 0).mesh(box, std::numeric_limits<int>::max());
  });
}

TEST(ExtremeMirrors, BendNoPointsBeyondTheLimit) {
  const Sphere sphere({0, 0, -2}, 2);
  Points points = RandomCloud(2).box(20);
  points(3, 1) = 1e51;
  expect_error<InvalidInput>("the points extend over 1e+51; allowed is up to 1e+50",
                             [&] { bend(points, sphere); });
}

// They were compared with each other, all with all: minutes.
TEST(HeightField, TakesManyNodesOverOnePosition) {
  Points nodes = Points::Zero(200'000, 3);
  nodes.col(2).setLinSpaced(0, 1);
  const HeightField field(Vector3::UnitZ(), nodes);
  EXPECT_NEAR(field.foot(Vector3(0, 0, 5)).z(), 0, 1e-12);  // the first counts
}

}  // namespace
}  // namespace symsurf::extreme_mirrors_tests
