#include <gtest/gtest.h>
#include <symsurf/analyses.h>
#include <symsurf/context.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <string>

#include "random_cloud.h"
#include "seeds.h"

namespace symsurf::helical_symmetry_tests {
namespace {

constexpr double pitch = 0.6;

// Points of a wire about a helix of five turns and radius 1 around the z axis.
Points spring(RandomCloud& random, double hand) {
  Points points(4000, 3);
  for (auto row : points.rowwise()) {
    const double turn = random.uniform(0, 10 * std::numbers::pi);
    const double around = random.uniform(0, 2 * std::numbers::pi);
    const double r = 1 + 0.15 * std::cos(around);
    row << r * std::cos(turn), hand * r * std::sin(turn),
        pitch * turn / (2 * std::numbers::pi) + 0.15 * std::sin(around);
  }
  return points;
}

// Points of a body of revolution about the z axis.
Points vase(RandomCloud& random) {
  Points points(3000, 3);
  for (auto row : points.rowwise()) {
    const double turn = random.uniform(0, 2 * std::numbers::pi), z = random.uniform(0, 3);
    const double r = 1 + 0.3 * std::sin(3 * z);
    row << r * std::cos(turn), r * std::sin(turn), z;
  }
  return points;
}

std::string text(const AnalysisResult& result, const char* name) {
  return std::get<std::string>(result.statistics.at(name));
}
double number(const AnalysisResult& result, const char* name) {
  return std::get<double>(result.statistics.at(name));
}

TEST(HelicalSymmetry, FindsAxisPitchHandAndLengthInAnyPose) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed)
    for (const double hand : {1.0, -1.0}) {
      RandomCloud random(seed);
      const Points own = spring(random, hand);
      const Matrix3 turn = random.rotation();
      const Vector3 shift = 5 * random.direction();
      const Points points = (3 * own * turn.transpose()).rowwise() + shift.transpose();
      const AnalysisResult found = analyse("helical_symmetry", points);
      EXPECT_EQ(text(found, "verdict"), "found");
      EXPECT_EQ(text(found, "handedness"), hand > 0 ? "right" : "left");
      EXPECT_NEAR(number(found, "pitch"), 3 * pitch, 0.01 * 3 * pitch);
      EXPECT_NEAR(number(found, "length"), 3 * 3.3, 0.6);
      ASSERT_EQ(found.axes.size(), 1u);
      EXPECT_GT(std::abs(found.axes[0].direction.dot(turn.col(2))), 0.9999);
      EXPECT_LT((found.axes[0].point - shift).cross(turn.col(2)).norm(), 0.05);
      ASSERT_EQ(found.transformations.size(), 1u);
      const Matrix4& screw = found.transformations[0].matrix;
      EXPECT_NEAR(screw.determinant(), 1, 1e-9);
      EXPECT_NEAR(screw.trace(), 2, 1e-9);  // a quarter of a turn
    }
}

TEST(HelicalSymmetry, RevolutionsBoxesAndScatteredPointsHaveNone) {
  RandomCloud random(1);
  Points flat = random.box(2000);
  flat.col(2).setZero();
  for (const Points& points : {vase(random), random.sphere(2000), random.box(2000), flat}) {
    const AnalysisResult found = analyse("helical_symmetry", points);
    EXPECT_EQ(text(found, "verdict"), "none");
    EXPECT_FALSE(text(found, "reason").empty());
    EXPECT_TRUE(found.axes.empty());
    EXPECT_TRUE(found.transformations.empty());
    EXPECT_EQ(found.arrays.at("helical").sum(), 0);
  }
}

TEST(HelicalSymmetry, HasTheSameBitsForAnyNumberOfThreads) {
  RandomCloud random(2);
  const Points points = spring(random, 1);
  const AnalysisResult one = analyse("helical_symmetry", points, {}, Context(nullptr, 1)),
                       three = analyse("helical_symmetry", points, {}, Context(nullptr, 3));
  EXPECT_EQ(one.transformations[0].matrix, three.transformations[0].matrix);
}

}  // namespace
}  // namespace symsurf::helical_symmetry_tests
