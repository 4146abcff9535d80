#include "score/mirror_score.h"

#include <gtest/gtest.h>
#include <symsurf/mirrors.h>

#include <cmath>
#include <random>
#include <vector>

#include "cloud/cloud.h"
#include "random_cloud.h"

namespace symsurf::mirror_score_tests {
namespace {

// An open, wavy surface on either side of x = 0, each with points of its own; no other mirror.
Points mirrored_surfaces(std::uint64_t seed, Index count = 3000) {
  RandomCloud random(seed);
  Points points(count, 3);
  for (Index i = 0; i < points.rows(); ++i) {
    const double y = random.uniform(-1, 1), z = random.uniform(-1.5, 1.5);
    const double x = 0.5 + 0.15 * std::sin(3 * y + 1) + 0.1 * z * y + 0.05 * std::cos(4 * z + 2);
    points.row(i) << (i % 2 ? x : -x), y, z;
  }
  return points;
}

// Noise whose root mean square is that share of the points' diagonal.
Points gaussian(const Points& points, double share, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const double diagonal = (points.colwise().maxCoeff() - points.colwise().minCoeff()).norm();
  std::normal_distribution<double> normal(0, share * diagonal / std::sqrt(3));
  return points.unaryExpr([&](double) { return normal(random); });
}

struct Scored {
  explicit Scored(const Points& points)
      : cloud(checked_cloud(points, {}, 4, {})), score(cloud, {}) {}
  double operator()(const Mirror& mirror) const {
    return score_of(score.fit(mirror), mirror.kind());
  }
  Cloud cloud;
  MirrorScore score;
};

TEST(MirrorScore, IsHighForTheTruthAndLowBesideIt) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    const Points points = mirrored_surfaces(seed);
    const Scored score(points);
    EXPECT_GT(score(Plane({1, 0, 0}, 0)), 0.9) << seed;
    EXPECT_LT(score(Plane({1, 0, 0}, 0.1)), 0.3) << seed;
    EXPECT_LT(score(Plane(RandomCloud(seed).direction(), 0.2)), 0.5) << seed;
    EXPECT_LT(score(Sphere({-2, 0, 0}, 2)), 0.5) << seed;
  }
}

// Noise of 2 % of the diagonal, and sides that are unlike by less.
TEST(MirrorScore, TellsTheUnlikeFromTheNoisy) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    const Points alike = mirrored_surfaces(seed);
    Points unlike = alike;
    for (Index i = 1; i < unlike.rows(); i += 2)
      unlike(i, 0) += 0.12 * std::sin(5 * unlike(i, 1)) * std::cos(4 * unlike(i, 2));
    const Points noise = gaussian(alike, 0.02, seed);
    const Plane plane({1, 0, 0}, 0);
    const double score = Scored(alike + noise)(plane);
    EXPECT_GT(score, 0.9) << seed;
    EXPECT_LT(Scored(unlike + noise)(plane), score - 0.1) << seed;
  }
}

// Of two mirrors that act alike the simpler one is meant.
TEST(MirrorScore, PrefersThePlaneToACylinderThatIsNearlyOne) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    const Points points = mirrored_surfaces(seed);
    const Cylinder cylinder({-1e4, 0, 0}, {0, 1, 0}, 1e4);
    EXPECT_LT(Scored(points).score.nats(cylinder, Plane({1, 0, 0}, 0), 3), 0) << seed;
  }
}

TEST(MirrorScore, DoesNotDependOnUnitAndPose) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    const Points points = mirrored_surfaces(seed);
    const Matrix3 rotation = RandomCloud(seed + 50).rotation();
    const Vector3 shift(1e3, -20, 7);
    const Points moved = (1e-3 * points * rotation.transpose()).rowwise() + shift.transpose();
    const Plane plane({1, 0.02, 0}, 0.01);
    EXPECT_NEAR(Scored(points)(plane), Scored(moved)(*plane.transformed(1e-3, rotation, shift)),
                0.01)
        << seed;
  }
}

// A cylinder about the surfaces' own mirror carries images onto the bent surfaces exactly.
TEST(MirrorScore, IsTheSameForAShapeAndItsBentCopy) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    const Points straight = mirrored_surfaces(seed);
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

TEST(MirrorScore, DoesNotDependOnTheNumberOfPoints) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    const Plane plane({1, 0, 0}, 0), beside({1, 0, 0}, 0.02);
    const Points many = mirrored_surfaces(seed, 60000);
    const double score = Scored(many)(plane), score_beside = Scored(many)(beside);
    for (const Index count : {1500, 5000, 20000}) {
      const Points fewer = mirrored_surfaces(seed, count);
      EXPECT_NEAR(Scored(fewer)(plane), score, 0.05) << seed << ' ' << count;
      EXPECT_NEAR(Scored(fewer)(beside), score_beside, 0.15) << seed << ' ' << count;
    }
  }
}

// Of 0.3 and 1 % of the diagonal, sides that are alike, nearly alike and unlike.
TEST(MirrorScore, IsNotRaisedByNoise) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed)
    for (const double bump : {0.0, 0.02, 0.12}) {
      Points points = mirrored_surfaces(seed);
      for (Index i = 1; i < points.rows(); i += 2)
        points(i, 0) += bump * std::sin(5 * points(i, 1)) * std::cos(4 * points(i, 2));
      const Plane plane({1, 0, 0}, 0);
      const double clean = Scored(points)(plane);
      for (const double share : {0.003, 0.01}) {
        const double noisy = Scored(points + gaussian(points, share, seed))(plane);
        // What differs by less than the noise is hidden by it; the unlike is not taken for alike.
        const double most = bump < 0.1 ? clean + 0.15 : 0.6;
        EXPECT_LT(noisy, most) << seed << ' ' << bump << ' ' << share;
      }
    }
}

// Points without a partner count against a mirror.
TEST(MirrorScore, FallsWithTheShareThatIsMissing) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    const Points points = mirrored_surfaces(seed);
    std::vector<Index> kept;
    for (Index i = 0; i < points.rows(); ++i)
      if (points(i, 0) > 0 || points(i, 2) < 0) kept.push_back(i);
    const double score = Scored(points(kept, Eigen::indexing::all))(Plane({1, 0, 0}, 0));
    EXPECT_NEAR(score, 2.0 / 3, 0.1) << seed;
  }
}

}  // namespace
}  // namespace symsurf::mirror_score_tests
