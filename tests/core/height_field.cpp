#include <gtest/gtest.h>
#include <symsurf/context.h>
#include <symsurf/mirrors.h>

#include <cmath>

#include "expect_error.h"
#include "random_cloud.h"

namespace symsurf::height_field_tests {
namespace {

double wave(double x, double y) { return std::sin(0.7 * x) * std::cos(0.7 * y); }

// The graph of a function over z, in a random pose.
struct Pose {
  explicit Pose(RandomCloud& random) : rotation(random.rotation()), shift(5 * random.in_box()) {}
  Vector3 operator()(const Vector3& x) const { return rotation * x + shift; }
  Vector3 undone(const Vector3& x) const { return rotation.transpose() * (x - shift); }
  Matrix3 rotation;
  Vector3 shift;
};

template <typename Function>
HeightField graph(RandomCloud& random, const Pose& pose, const Function& f, Index n) {
  Points nodes(n, 3);
  for (Index i = 0; i < n; ++i) {
    const double x = random.uniform(-2, 2), y = random.uniform(-2, 2);
    nodes.row(i) = pose({x, y, f(x, y)}).transpose();
  }
  return HeightField(3 * pose.rotation.col(2), nodes);
}

TEST(HeightField, PassesThroughItsNodes) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    RandomCloud random(seed);
    const Pose pose(random);
    const HeightField field = graph(random, pose, wave, 400);
    EXPECT_LE((field.project(field.nodes()) - field.nodes()).cwiseAbs().maxCoeff(), 1e-12);
  }
}

TEST(HeightField, IsCloseToTheFunctionBetweenItsNodes) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    RandomCloud random(seed);
    const Pose pose(random);
    const HeightField field = graph(random, pose, wave, 1600);
    for (int i = 0; i < 200; ++i) {
      const double x = random.uniform(-1.8, 1.8), y = random.uniform(-1.8, 1.8);
      const Vector3 foot = pose.undone(field.foot(pose({x, y, random.uniform(-3, 3)})));
      EXPECT_NEAR(foot.x(), x, 1e-12);
      EXPECT_NEAR(foot.y(), y, 1e-12);
      EXPECT_NEAR(foot.z(), wave(x, y), 2e-3);
    }
  }
}

TEST(HeightField, TakesTheFirstOfNodesOverEachOther) {
  RandomCloud random(2);
  Points nodes = random.box(100), doubled(120, 3);
  const Vector3 direction = random.direction();
  doubled << nodes, nodes.topRows(20);
  for (Index i = 100; i < 120; ++i) doubled.row(i) += random.uniform(1, 2) * direction.transpose();
  const HeightField field(direction, nodes), same(direction, doubled);
  for (int k = 0; k < 100; ++k) {
    const Vector3 x = k < 20 ? Vector3(nodes.row(k)) : random.in_box();
    for (const double aside : {0.0, 1e-9, 1e-3})
      EXPECT_NEAR(same.signed_distance(Vector3(x + aside * direction.unitOrthogonal())),
                  field.signed_distance(Vector3(x + aside * direction.unitOrthogonal())), 1e-9);
  }
}

TEST(HeightField, ContinuesAPlaneExactlyBeyondItsNodes) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    RandomCloud random(seed);
    const Pose pose(random);
    const auto plane = [](double x, double y) { return 0.3 * x - 0.8 * y + 1; };
    const HeightField field = graph(random, pose, plane, 50);
    for (int i = 0; i < 100; ++i) {
      const Vector3 at = 20 * random.in_box(), foot = pose.undone(field.foot(pose(at)));
      EXPECT_NEAR(foot.z(), plane(at.x(), at.y()), 1e-6);
    }
  }
}

TEST(HeightField, ReflectedTwiceIsThePoint) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    RandomCloud random(seed);
    const Pose pose(random);
    const HeightField field = graph(random, pose, wave, 100);
    const Points points = 2 * random.box(100), images = field.reflect(points);
    EXPECT_LE((field.reflect(images) - points).cwiseAbs().maxCoeff(), 1e-9);
    EXPECT_LE((field.signed_distance(images) + field.signed_distance(points)).cwiseAbs().maxCoeff(),
              1e-9);
    const Points chords = images - points;
    EXPECT_LE(chords.rowwise().cross(field.direction()).cwiseAbs().maxCoeff(), 1e-12);
  }
}

TEST(HeightField, MovesWithTheSpaceAndComesBackFromItsNumbers) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    RandomCloud random(seed);
    const Pose pose(random), other(random);
    const HeightField field = graph(random, pose, wave, 200);
    const auto moved = field.transformed(2, other.rotation, other.shift);
    const auto same = make_mirror(field.kind(), field.numbers());
    for (int i = 0; i < 50; ++i) {
      const Vector3 x = pose(2 * random.in_box());
      const Vector3 expected = 2 * (other.rotation * field.reflect(x)) + other.shift;
      const Vector3 there = 2 * (other.rotation * x) + other.shift;
      EXPECT_LE((moved->reflect(there) - expected).norm(), 1e-9);
      EXPECT_LE((same->reflect(x) - field.reflect(x)).norm(), 1e-9);
    }
  }
}

TEST(HeightField, MeshesTheFootprintAndLeavesGapsOpen) {
  RandomCloud random(0);
  const Pose pose(random);
  const HeightField field = graph(random, pose, wave, 1000);
  // The object is a ring.
  Points ring(3000, 3);
  for (Index i = 0; i < ring.rows(); ++i) {
    const double radius = random.uniform(1, 1.8), angle = random.uniform(0, 7);
    ring.row(i) = pose({radius * std::cos(angle), radius * std::sin(angle), 3}).transpose();
  }
  const Mesh mesh = field.mesh(ring, 40);
  double area = 0;
  for (Index t = 0; t < mesh.triangles.rows(); ++t) {
    Matrix3 corners;
    for (int c = 0; c < 3; ++c)
      corners.col(c) = pose.undone(mesh.vertices.row(mesh.triangles(t, c)).transpose());
    corners.row(2).setOnes();
    area += std::abs(corners.determinant()) / 2;
    const Vector3 middle = corners.rowwise().mean();
    EXPECT_GT(middle.head<2>().norm(), 0.8);
    EXPECT_LT(middle.head<2>().norm(), 2.0);
  }
  // No farther out than a cell and a half.
  const double cell = 3.6 / 40, perimeter = 2 * M_PI * (1.8 + 1);
  EXPECT_NEAR(area, M_PI * (1.8 * 1.8 - 1), 1.5 * cell * perimeter);
  EXPECT_LE((field.project(mesh.vertices) - mesh.vertices).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(HeightField, RefusesWhatIsNone) {
  const Points node = Points::Zero(1, 3);
  expect_error<InvalidInput>("direction", [&] { HeightField({0, 0, 0}, node); });
  expect_error<InvalidInput>("direction", [&] { HeightField({NAN, 0, 1}, node); });
  expect_error<InvalidInput>("node", [&] { HeightField({0, 0, 1}, Points(0, 3)); });
  expect_error<InvalidInput>("node", [&] { HeightField({0, 0, 1}, Points::Constant(2, 3, NAN)); });
}

TEST(HeightField, OfOneNodeIsFlat) {
  const HeightField field({0, 0, 2}, Points::Ones(1, 3));
  EXPECT_EQ(field.reflect(Vector3(5, 6, 3)), Vector3(5, 6, -1));
  EXPECT_EQ(field.foot(Vector3(1, 1, 7)), Vector3(1, 1, 1));
}

TEST(HeightField, NormalIsThatOfItsHeights) {
  RandomCloud random(3);
  Points nodes = random.box(300);
  for (Index i = 0; i < nodes.rows(); ++i)
    nodes(i, 2) = 0.3 * std::sin(3 * nodes(i, 0)) * std::cos(2 * nodes(i, 1));
  const Matrix3 rotation = random.rotation();
  const HeightField field(rotation.col(2), nodes * rotation.transpose());
  for (int k = 0; k < 200; ++k) {
    const Vector3 x = 1.5 * random.in_box();
    const Vector3 at = rotation * x, normal = field.normal(at);
    constexpr double h = 1e-6;
    for (int axis = 0; axis < 2; ++axis) {
      const Vector3 aside = h * rotation.col(axis);
      const Vector3 along = (field.foot(at + aside) - field.foot(at - aside)) / (2 * h);
      EXPECT_NEAR(along.dot(normal), 0, 1e-6) << k;
    }
    EXPECT_NEAR(normal.norm(), 1, 1e-14);
    EXPECT_GT(normal.dot(rotation.col(2)), 0);
  }
  EXPECT_LE((field.normal(rotation * nodes.row(5).transpose()) -
             field.normal(rotation * (nodes.row(5).transpose() + Vector3(1e-9, 0, 0))))
                .norm(),
            1e-6);
}

}  // namespace
}  // namespace symsurf::height_field_tests
