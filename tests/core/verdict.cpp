#include <gtest/gtest.h>
#include <symsurf/detect.h>
#include <symsurf/errors.h>
#include <symsurf/found_mirror.h>

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

}  // namespace
}  // namespace symsurf
