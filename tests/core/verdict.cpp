#include <gtest/gtest.h>
#include <symsurf/detect.h>
#include <symsurf/errors.h>
#include <symsurf/found_mirror.h>
#include <symsurf/match.h>
#include <symsurf/plane.h>

#include <cmath>
#include <string>
#include <vector>

#include "expect_error.h"
#include "random_cloud.h"

namespace symsurf {
namespace {

TEST(Verdict, NamesTheScoreThatIsMissing) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed)
    for (const char* method : {"plane", "sphere"}) {
      const Result result = detect(RandomCloud(seed).box(150), {.method = method});
      ASSERT_EQ(result.verdict(), "none") << method << ' ' << seed;
      const double score = std::floor(1e4 * result.score) / 1e4;
      const std::string below =
          result.method + " scores " + to_string(Value(score)) + ", below the minimum_score of 0.5";
      EXPECT_EQ(result.reason().substr(0, below.size()), below) << method << ' ' << seed;
    }
}

TEST(Verdict, SaysWhatAutoTriedWhereNothingFits) {
  const Result result = detect(RandomCloud(0).box(150));
  ASSERT_EQ(result.verdict(), "none");
  const std::string reason = result.reason();
  EXPECT_TRUE(reason.starts_with(result.method + " scores 0.")) << reason;
  EXPECT_NE(reason.find(", below the minimum_score of 0.5; " + result.method +
                        " is the simplest of those that explain most"),
            std::string::npos)
      << reason;
}

TEST(Verdict, OfWhatNeedsAMirror) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    const Result none = detect(RandomCloud(seed).box(150), {.method = "plane"});
    EXPECT_EQ(found_mirror(none).mirror, none.mirror);
    const std::string& warning = found_mirror(none).warning;
    EXPECT_NE(warning.find(none.reason() + "; "), std::string::npos) << warning;
    EXPECT_NE(warning.find(require_found_parameter().name), std::string::npos) << warning;
    expect_error<InvalidInput>("the shape has no mirror: " + none.reason(),
                               [&] { found_mirror(none, true); });
    const Points half = RandomCloud(seed).box(60);
    Points points(120, 3);
    points << half, half * Vector3(-1, 1, 1).asDiagonal();
    const Result found = detect(points, {.method = "plane"});
    for (const bool require_found : {false, true}) {
      EXPECT_EQ(found_mirror(found, require_found).mirror, found.mirror);
      EXPECT_EQ(found_mirror(found, require_found).warning, "");
    }
  }
  Result pairs_only;
  pairs_only.method = "separation";
  pairs_only.statistics = {{"verdict", std::string("found")}, {"reason", std::string()}};
  expect_error<InvalidInput>("separation has no mirror", [&] { found_mirror(pairs_only); });
  pairs_only.statistics = {{"verdict", std::string("none")}, {"reason", std::string("no pairs")}};
  expect_error<InvalidInput>("the shape has no mirror: no pairs",
                             [&] { found_mirror(pairs_only); });
}

// A plane is all that a well mirrored shape needs; asked for more, auto names what is missing. A
// cap of the shape is cut off.
TEST(Verdict, OfAMirrorBelowAHighMinimum) {
  RandomCloud random(1);
  Points points = random.sphere(3000);
  std::vector<Index> kept;
  for (Index i = 0; i < points.rows(); ++i)
    if (points.row(i).dot(Eigen::RowVector3d(1, 1, 1)) < 1.2) kept.push_back(i);
  points = points(kept, Eigen::all).eval();
  points.leftCols(1) *= 3;
  points.rightCols(1) *= 0.4;
  Options options;
  const Result found = detect(points, options);
  ASSERT_EQ(found.verdict(), "found");
  EXPECT_EQ(found.reason().find("minimum_score"), std::string::npos) << found.reason();
  options.parameters["minimum_score"] = 1.0;
  const Result none = detect(points, options);
  ASSERT_EQ(none.verdict(), "none");
  EXPECT_NE(none.reason().find("below the minimum_score of 1; "), std::string::npos)
      << none.reason();
}

// A flat sheet without a mirror slides over itself along any upright plane.
TEST(Verdict, OfASheetThatSlides) {
  const Vector3 corners[] = {{0, 0, 0}, {1.3, 0.1, 0}, {0.9, 0.8, 0}, {0.1, 0.5, 0}};
  const auto is_inside = [&](const Vector3& x) {
    for (int k = 0; k < 4; ++k)
      if ((corners[(k + 1) % 4] - corners[k]).cross(x - corners[k]).z() < 0) return false;
    return true;
  };
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    RandomCloud random(seed);
    Points points(3000, 3);
    for (Index i = 0; i < points.rows();) {
      const Vector3 x = 1.3 * random.in_box().cwiseProduct(Vector3(1, 1, 0));
      if (is_inside(x)) points.row(i++) = x.transpose();
    }
    const Result result =
        detect(Points(points * random.rotation().transpose()), {.method = "plane"});
    EXPECT_EQ(result.verdict(), "none") << seed << ' ' << result.reason();
  }
}

// Two sheets that face each other, one of which is thicker by half a hundredth of the diagonal.
TEST(Verdict, DependsOnTheTolerance) {
  const auto relief = [](double y, double z) { return 1 + 0.3 * std::sin(3 * y + z) + 0.3 * z; };
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    RandomCloud random(seed);
    Points points(3000, 3);
    for (Index i = 0; i < points.rows(); ++i) {
      const double y = random.uniform(-1, 1), z = random.uniform(-1, 1), x = relief(y, z);
      const double unlike = 0.02 * std::sin(4 * y) * std::cos(3 * z);
      points.row(i) << (i % 2 == 0 ? x + unlike : -x), y, z;
    }
    const Plane plane(Vector3::UnitX(), 0);
    double last = 0;
    for (const double tolerance : {0.001, 0.004, 0.016}) {
      const double score = match(points, plane, 0.05, {}, false, tolerance).score;
      EXPECT_GT(score, last) << seed << ' ' << tolerance;
      last = score;
    }
    EXPECT_GT(last, 0.9) << seed;
    EXPECT_EQ(std::get<double>(
                  detect(points, {.parameters = {{"tolerance", 0.01}}}).parameters.at("tolerance")),
              0.01);
  }
  expect_error<InvalidParameter>("tolerance is 0.5; allowed is [0.0001, 0.1]", [] {
    match(RandomCloud(0).box(50), Plane(Vector3::UnitX(), 0), 0.05, {}, false, 0.5);
  });
}

}  // namespace
}  // namespace symsurf
