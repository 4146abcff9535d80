// Mirrors without the pairs of the points: the parameter "pairs".

#include <gtest/gtest.h>
#include <symsurf/detect.h>

#include "bumpy_ball.h"

namespace symsurf::without_pairs_tests {
namespace {

Result found(PointsView points, const std::string& method, bool pairs, TrianglesView faces = {}) {
  return detect(points, {.method = method, .parameters = {{"pairs", pairs}}, .faces = faces});
}

void expect_the_same_but_pairs(PointsView points, const std::string& method,
                               TrianglesView faces = {}) {
  const Result with = found(points, method, true, faces);
  const Result without = found(points, method, false, faces);
  ASSERT_TRUE(with.mirror && without.mirror) << method;
  EXPECT_GT(with.pairs.rows(), 0) << method;
  EXPECT_EQ(without.pairs.rows(), 0) << method;
  EXPECT_EQ(without.residuals.size(), 0) << method;
  EXPECT_EQ(without.surface_points.rows(), 0) << method;
  EXPECT_FALSE(without.statistics.contains("unpaired_points")) << method;
  EXPECT_EQ(without.method, with.method);
  EXPECT_EQ(without.score, with.score) << method;
  EXPECT_EQ(without.statistics.at("verdict"), with.statistics.at("verdict")) << method;
  EXPECT_EQ(*without.mirror, *with.mirror) << method;
}

TEST(WithoutPairs, MirrorAndScoreAreTheSame) {
  const Points straight = ball(1).points, bent = wrapped(straight);
  for (const char* method : {"auto", "plane", "perpendicular", "fixed_direction", "plane_icp"})
    expect_the_same_but_pairs(straight, method);
  for (const char* method : {"auto", "cylinder", "sphere", "quadric"})
    expect_the_same_but_pairs(bent, method);
}

TEST(WithoutPairs, SoTheyAreOfMeshesAndBodiesFilledWithPoints) {
  const Ball b = ball(2);
  expect_the_same_but_pairs(b.points, "auto", b.faces);
  RandomCloud random(3);
  Points half = random.box(1500);
  half.col(0).array() += 1;
  Points body(3000, 3);
  body << half, half * Vector3(-1, 1, 1).asDiagonal();
  expect_the_same_but_pairs(body, "plane");
}

}  // namespace
}  // namespace symsurf::without_pairs_tests
