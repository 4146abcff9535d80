#include "mirror_score.h"

#include <gtest/gtest.h>
#include <symsurf/cylinder.h>
#include <symsurf/plane.h>
#include <symsurf/sphere.h>

#include <cmath>

#include "cloud.h"
#include "random_cloud.h"

namespace symsurf {
namespace {

// An open, wavy sheet on either side of x = 0, each with points of its own; no other mirror.
Points mirrored_sheets(std::uint64_t seed) {
  RandomCloud random(seed);
  Points points(3000, 3);
  for (Index i = 0; i < points.rows(); ++i) {
    const double y = random.uniform(-1, 1), z = random.uniform(-1.5, 1.5);
    const double x = 0.5 + 0.15 * std::sin(3 * y + 1) + 0.1 * z * y + 0.05 * std::cos(4 * z + 2);
    points.row(i) << (i % 2 ? x : -x), y, z;
  }
  return points;
}

struct Scored {
  explicit Scored(const Points& points)
      : cloud(checked_cloud(points, {}, 4, {})),
        tree(points),
        nearest(points, tree, {}),
        score(cloud, nearest, {}) {}
  double operator()(const Mirror& mirror) const {
    return discounted(score.explained(mirror), mirror.kind());
  }
  Cloud cloud;
  PointTree tree;
  NearestPoints nearest;
  MirrorScore score;
};

TEST(MirrorScore, IsHighForTheTruthAndLowBesideIt) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    const Points points = mirrored_sheets(seed);
    const Scored score(points);
    EXPECT_GT(score(Plane({1, 0, 0}, 0)), 0.9) << seed;
    EXPECT_LT(score(Plane({1, 0, 0}, 0.1)), 0.3) << seed;
    EXPECT_LT(score(Plane(RandomCloud(seed).direction(), 0.2)), 0.5) << seed;
    EXPECT_LT(score(Sphere({-2, 0, 0}, 2)), 0.5) << seed;
  }
}

// Of two mirrors that act alike the simpler one is meant.
TEST(MirrorScore, PrefersThePlaneToACylinderThatIsNearlyOne) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    const Points points = mirrored_sheets(seed);
    const Scored score(points);
    EXPECT_GT(score(Plane({1, 0, 0}, 0)), score(Cylinder({-1e4, 0, 0}, {0, 1, 0}, 1e4))) << seed;
  }
}

TEST(MirrorScore, DoesNotDependOnUnitAndPose) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    const Points points = mirrored_sheets(seed);
    const Matrix3 rotation = RandomCloud(seed + 50).rotation();
    const Vector3 shift(1e3, -20, 7);
    const Points moved = (1e-3 * points * rotation.transpose()).rowwise() + shift.transpose();
    const Plane plane({1, 0.02, 0}, 0.01);
    EXPECT_NEAR(Scored(points)(plane), Scored(moved)(*plane.transformed(1e-3, rotation, shift)),
                0.01)
        << seed;
  }
}

// A cylinder about the sheets' own mirror carries images onto the bent sheets exactly.
TEST(MirrorScore, IsTheSameForAShapeAndItsBentCopy) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    const Points straight = mirrored_sheets(seed);
    const double radius = 3;
    Points bent(straight.rows(), 3);
    for (Index i = 0; i < straight.rows(); ++i) {
      const double angle = straight(i, 2) / radius, r = radius + straight(i, 0);
      bent.row(i) << r * std::cos(angle), straight(i, 1), r * std::sin(angle);
    }
    EXPECT_GT(Scored(bent)(Cylinder({0, 0, 0}, {0, 1, 0}, radius)), 0.9) << seed;
    EXPECT_LT(Scored(bent)(Plane({1, 0, 0}, -radius)), 0.5) << seed;
  }
}

}  // namespace
}  // namespace symsurf
