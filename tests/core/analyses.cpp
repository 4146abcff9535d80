#include <gtest/gtest.h>
#include <symsurf/analyses.h>
#include <symsurf/context.h>

#include <Eigen/Geometry>
#include <limits>
#include <numbers>

#include "expect_error.h"
#include "random_cloud.h"
#include "symmetries/analysis.h"

namespace symsurf::analyses_tests {
namespace {

// A random cloud and its image in the plane x = 0.
Points mirrored_cloud(Index half) {
  const Points one = RandomCloud(0).box(half) + Vector3(3, 0, 0).transpose().replicate(half, 1);
  Points both(2 * half, 3);
  both << one, one;
  both.col(0).tail(half) *= -1;
  return both;
}

TEST(Analyses, TellTheSymmetriesThatTheirOwnFunctionFinds) {
  const Points points = mirrored_cloud(500);
  const Symmetries expected = find_symmetries(points);
  const AnalysisResult found = analyse("symmetries", points);
  EXPECT_EQ(expected.group, "Cs");
  EXPECT_EQ(std::get<std::string>(found.statistics.at("group")), "Cs");
  ASSERT_EQ(found.planes.size(), 1u);
  EXPECT_TRUE(found.planes[0] == expected.planes[0]);
  ASSERT_EQ(found.transformations.size(), 2u);
  EXPECT_EQ(found.transformations[0].kind, "identity");
  EXPECT_EQ(found.transformations[1].kind, "reflection");
  EXPECT_EQ(found.transformations[1].matrix, expected.elements[1]);
}

TEST(Analyses, LeaveOutPointsThatAreNotFinite) {
  Points points = mirrored_cloud(500);
  const AnalysisResult whole = analyse("symmetries", points);
  Points more(points.rows() + 1, 3);
  more << Vector3::Constant(std::numeric_limits<double>::quiet_NaN()).transpose(), points;
  const AnalysisResult found = analyse("symmetries", more);
  EXPECT_EQ(std::get<Index>(found.statistics.at("nonfinite_points")), 1);
  EXPECT_TRUE(found.planes.at(0) == whole.planes.at(0));
  AnalysisOptions refusing;
  refusing.refuse_nonfinite = true;
  expect_error<InvalidInput>("point 0 is", [&] { analyse("symmetries", more, refusing); });
}

TEST(Analyses, NameWhatIsWrong) {
  const Points points = mirrored_cloud(50);
  expect_error<InvalidParameter>("there is no analysis 'symmetrie'; there are symmetries",
                                 [&] { analyse("symmetrie", points); });
  AnalysisOptions options;
  options.parameters["minimum_score"] = 2.0;
  expect_error<InvalidParameter>("minimum_score is 2; allowed is real [0, 1]",
                                 [&] { analyse("symmetries", points, options); });
  expect_error<InvalidInput>("2 points given",
                             [&] { analyse("symmetries", Points(points.topRows(2))); });
}

TEST(Analyses, DescribeEveryArrayThatTheyShow) {
  for (const Analysis& analysis : analyses()) {
    bool found = analysis.shown.empty();
    for (const PointArray& array : analysis.arrays) found = found || array.name == analysis.shown;
    EXPECT_TRUE(found) << analysis.name << " shows " << analysis.shown;
  }
}

TEST(TransformationKind, IsThatOfGeometry) {
  const auto kind = [](const Matrix3& linear, const Vector3& shift) {
    Matrix4 matrix = Matrix4::Identity();
    matrix.topLeftCorner<3, 3>() = linear;
    matrix.topRightCorner<3, 1>() = shift;
    return kind_of(matrix, Vector3(1, 2, 3), 1e-6, 1e-6);
  };
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    RandomCloud random(seed);
    const Vector3 axis = random.direction(), across = axis.unitOrthogonal(),
                  point = random.in_box();
    const Matrix3 one = Matrix3::Identity();
    const Matrix3 turn = Eigen::AngleAxisd(random.uniform(0.1, 3), axis).toRotationMatrix();
    const Matrix3 mirror = one - 2 * axis * axis.transpose();
    const auto about = [&](const Matrix3& linear) -> Vector3 { return point - linear * point; };
    EXPECT_EQ(kind(one, Vector3::Zero()), "identity");
    EXPECT_EQ(kind(one, across), "translation");
    EXPECT_EQ(kind(turn, about(turn)), "rotation");
    EXPECT_EQ(kind(turn, about(turn) + axis), "screw");
    EXPECT_EQ(kind(mirror, about(mirror)), "reflection");
    EXPECT_EQ(kind(mirror, about(mirror) + across), "glide reflection");
    EXPECT_EQ(kind(-one, 2 * point), "inversion");
    EXPECT_EQ(kind(turn * mirror, about(turn * mirror)), "rotary reflection");
    EXPECT_EQ(kind(1.1 * turn, axis), "similarity");
    EXPECT_EQ(kind(0.9 * mirror, axis), "similarity");
  }
}

TEST(SymmetryAxis, IsDrawnAlongThePoints) {
  Points points(2, 3);
  points << 0, 0, 0, 5, 7, 10;
  const SymmetryAxis axis{Vector3(1, 2, 3), Vector3::UnitZ(), 2};
  const auto [low, high] = axis.segment(points);
  EXPECT_EQ(low, Vector3(1, 2, -1));
  EXPECT_EQ(high, Vector3(1, 2, 11));
  expect_error<InvalidInput>("0 points given", [&] { axis.segment(Points(0, 3)); });
}

}  // namespace
}  // namespace symsurf::analyses_tests
