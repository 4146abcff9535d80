#include <gtest/gtest.h>
#include <symsurf/mirrors.h>
#include <symsurf/operations.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "bumpy_ball.h"
#include "figure.h"
#include "random_cloud.h"

namespace symsurf::asymmetry_tests {
namespace {

double diagonal(const Points& points) {
  return (points.colwise().maxCoeff() - points.colwise().minCoeff()).norm();
}

// Points near the centre of a sphere have no image, but may be the image of others.
TEST(Asymmetry, IsConfidentOfPointsWithoutAnImage) {
  Points points(8, 3);
  points << .9, 0, .5, .8, 0, .7, .4, -.4, .5, .1, -.8, -.2, -.9, 0, -.1, -.2, .2, -.8, .9, .4, .6,
      .8, .2, -.9;
  const OperationResult result = operate("asymmetry", {points}, Sphere(Vector3(.4, .1, .7), .7),
                                         {{"max_distance", 1.0}, {"max_angle", 90.0}});
  EXPECT_TRUE(result.arrays.at("confidence").allFinite());
}

TEST(Asymmetry, IsZeroWhateverTheTriangulation) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    const Ball b = ball(seed);
    const OperationResult flat = operate("asymmetry", {b.points, b.faces}, middle);
    EXPECT_EQ(figure(flat, "matched_share"), 1);
    EXPECT_LE(figure(flat, "maximum_of_diagonal"), 1e-12) << seed;
    EXPECT_NEAR(figure(flat, "area_index"), 0, 0.01);
    EXPECT_NEAR(figure(flat, "volume_index"), 0, 0.01);
    const OperationResult bent = operate("asymmetry", {wrapped(b.points), b.faces}, round_mirror);
    EXPECT_EQ(figure(bent, "matched_share"), 1);
    EXPECT_LE(figure(bent, "maximum_of_diagonal"), 1e-12) << seed;
  }
}

TEST(Asymmetry, IsAsHighAsABumpAndNothingElsewhere) {
  const Ball b = ball(1);
  Eigen::VectorXd raised;
  const Points with_bump = bumped(b.points, 0.05, raised);
  Index highest;
  ASSERT_GT(raised.maxCoeff(&highest), 0.04);
  for (const bool bent : {false, true}) {
    const Mirror& mirror = bent ? static_cast<const Mirror&>(round_mirror) : middle;
    const Points points = bent ? wrapped(with_bump) : with_bump;
    const OperationResult result = operate("asymmetry", {points, b.faces}, mirror);
    const Eigen::MatrixXd &distance = result.arrays.at("distance"),
                          &outward = result.arrays.at("signed");
    const Points flat = bent ? wrapped(b.points) : b.points;
    const double height = (points.row(highest) - flat.row(highest)).norm();
    EXPECT_NEAR(outward(highest, 0), -height, 0.05 * height) << bent;
    EXPECT_NEAR(distance(highest, 0), height, 0.05 * height) << bent;
    for (Index i = 0; i < points.rows(); ++i) {
      if (raised[i] == 0 && raised[b.partner[i]] == 0) {
        EXPECT_LE(distance(i, 0), 1e-3 * diagonal(points)) << bent << ' ' << i;
      }
    }
  }
}

// A disc as thick as a twentieth of the shift: the mirrored rear is closer to the front than the
// mirrored front is.
TEST(Asymmetry, OfThinPartsIsFromFrontToFront) {
  Ball b = ball(2);
  const double shift = 0.05;
  for (Index i = 0; i < b.points.rows(); ++i) {
    b.points.row(i).normalize();
    b.points(i, 2) *= 0.01;
    const double x = b.points(i, 0);
    if (x > 0) b.points(i, 2) += shift * x * x * (3 - 2 * x);
  }
  const OperationResult result = operate("asymmetry", {b.points, b.faces}, middle);
  EXPECT_GT(figure(result, "matched_share"), 0.9);
  const Eigen::MatrixXd& distance = result.arrays.at("distance");
  for (Index i = 0; i < b.points.rows(); ++i) {
    const Vector3 x = b.points.row(i).transpose();
    if (x.head<2>().norm() > 0.9 || result.arrays.at("matched")(i, 0) == 0) continue;
    const double raised = shift * x.x() * x.x() * (3 - 2 * std::abs(x.x()));
    EXPECT_NEAR(distance(i, 0), raised, 0.15 * raised + 0.002) << x.transpose();
  }
}

TEST(Asymmetry, OfACloudIsThatOfItsSurface) {
  const Ball b = ball(2);
  Eigen::VectorXd raised;
  const Points points = bumped(b.points, 0.05, raised);
  const OperationResult result = operate("asymmetry", {points}, middle);
  EXPECT_GT(figure(result, "matched_share"), 0.95);
  EXPECT_NEAR(result.arrays.at("distance")
                  .array()
                  .isFinite()
                  .select(result.arrays.at("distance").array(), 0)
                  .maxCoeff(),
              raised.maxCoeff(), 0.1 * raised.maxCoeff());
}

TEST(Asymmetry, HasNoneWhereTheOtherSideIsMissing) {
  const Ball b = ball(3);
  std::vector<Index> kept;
  for (Index f = 0; f < b.faces.rows(); ++f) {
    const Vector3 x = b.points.row(b.faces(f, 0)).transpose();
    if ((x - Vector3(1, 0, 0)).norm() > 0.5) kept.push_back(f);
  }
  Triangles faces(static_cast<Index>(kept.size()), 3);
  for (Index f = 0; f < faces.rows(); ++f) faces.row(f) = b.faces.row(kept[f]);
  const OperationResult result = operate("asymmetry", {b.points, faces}, middle);
  const Eigen::MatrixXd& matched = result.arrays.at("matched");
  for (Index i = 0; i < b.points.rows(); ++i) {
    const Vector3 image = b.points.row(i).transpose().cwiseProduct(Vector3(-1, 1, 1));
    const double to_hole = (image - Vector3(1, 0, 0)).norm();
    if (to_hole < 0.35 || to_hole > 0.75) {
      EXPECT_EQ(matched(i, 0), to_hole > 0.75) << i;
    }
    EXPECT_EQ(std::isfinite(result.arrays.at("distance")(i, 0)), matched(i, 0) == 1);
  }
  EXPECT_EQ(result.statistics.count("positive_volume"), 0u);
}

TEST(Asymmetry, IsThatOfTheSurface) {
  const Ball b = ball(2);
  Points points(b.points.rows() + 1, 3);
  points << b.points, 0.97 * b.points.row(0);  // a vertex that no face uses
  const OperationResult result = operate("asymmetry", {points, b.faces}, middle);
  EXPECT_EQ(result.arrays.at("matched")(b.points.rows(), 0), 1);
  EXPECT_EQ(figure(result, "rms"), 0);
  EXPECT_EQ(figure(result, "maximum"), 0);
}

// The part of a ball of radius r beyond a plane at a distance d: pi h^2 (3 r - h) / 3 and 2 pi r h,
// h = r - d.
TEST(Asymmetry, MeasuresBothSides) {
  Ball b = ball(4);
  for (Index i = 0; i < b.points.rows(); ++i) b.points.row(i).normalize();
  const double d = 0.3, h = 1 - d;
  const OperationResult result =
      operate("asymmetry", {b.points, b.faces}, Plane(Vector3::UnitX(), -d));
  EXPECT_NEAR(figure(result, "positive_area"), 2 * std::numbers::pi * h, 0.05);
  EXPECT_NEAR(figure(result, "negative_area"), 2 * std::numbers::pi * (2 - h), 0.08);
  EXPECT_NEAR(figure(result, "positive_volume"), std::numbers::pi * h * h * (3 - h) / 3, 0.03);
  EXPECT_NEAR(figure(result, "negative_volume"),
              4 * std::numbers::pi / 3 - std::numbers::pi * h * h * (3 - h) / 3, 0.05);
  // Of the ball and another of radius R = 3 with its centre at d = 3 the part that both have:
  // pi (R + 1 - d)^2 (d^2 + 2 d - 3 + 2 d R + 6 R - 3 R^2) / (12 d).
  const OperationResult cut =
      operate("asymmetry", {b.points, b.faces}, Sphere(Vector3(3, 0, 0), 3));
  EXPECT_NEAR(figure(cut, "negative_volume"), std::numbers::pi * 21 / 36, 0.05);
}

// Off by a hundredth of a face: no vertex has an exact partner.
TEST(Asymmetry, TakesNormalsForLinesWhereASideIsWoundTheOtherWay) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    Ball b = mirrored_without_turning(seed);
    b.points += 1e-3 * RandomCloud(seed).box(b.points.rows());
    const OperationResult result = operate("asymmetry", {b.points, b.faces}, middle);
    EXPECT_GT(figure(result, "matched_share"), 0.95);
    EXPECT_LT(figure(result, "p95"), 2e-3);
    EXPECT_NEAR(figure(result, "unmatched_share"), 1 - figure(result, "matched_share"), 1e-12);
  }
}

}  // namespace
}  // namespace symsurf::asymmetry_tests
