#include <gtest/gtest.h>
#include <symsurf/context.h>
#include <symsurf/detect.h>
#include <symsurf/mirrors.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "base/math.h"
#include "expect_error.h"
#include "random_cloud.h"
#include "test_mesh.h"

namespace symsurf::verdict_tests {
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
  Points points = random.sphere(1000);
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

// The walls and the lid of a box that stands on z = 0, turned about z.
void add_box(RandomCloud& random, const Vector3& at, const Vector3& size, double angle, Index count,
             std::vector<Vector3>& points) {
  const Matrix3 turn = Eigen::AngleAxisd(angle, Vector3::UnitZ()).toRotationMatrix();
  const double walls = 2 * (size.x() + size.y()) * size.z(), lid = size.x() * size.y();
  for (Index i = 0; i < count; ++i) {
    Vector3 x = random.in_box() / 2 + Vector3(0, 0, 0.5);
    if (random.uniform(0, 1) < lid / (walls + lid)) {
      x.z() = 1;
    } else {
      const bool along_x = random.uniform(0, size.x() + size.y()) < size.x();
      x[along_x ? 1 : 0] = random.uniform(0, 1) < 0.5 ? -0.5 : 0.5;
    }
    points.push_back(at + turn * x.cwiseProduct(size));
  }
}

// A round table top slides over itself: upright planes map it, and none maps the boxes on it.
TEST(Verdict, OfASheetThatSlides) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    RandomCloud random(seed);
    std::vector<Vector3> points;
    while (points.size() < 3000) {
      const Vector3 x = random.in_box().cwiseProduct(Vector3(1, 1, 0));
      if (x.norm() < 1) points.push_back(x);
    }
    add_box(random, {0.5, 0.1, 0}, {0.5, 0.3, 0.3}, 0.5, 600, points);
    add_box(random, {-0.35, 0.45, 0}, {0.3, 0.25, 0.5}, 1.2, 600, points);
    add_box(random, {-0.2, -0.55, 0}, {0.6, 0.2, 0.15}, 0.3, 350, points);
    const Points posed = rows_of(points) * random.rotation().transpose();
    const Result result = detect(posed, {.method = "plane"});
    EXPECT_EQ(result.verdict(), "none") << seed << ' ' << result.reason();
    EXPECT_GT(result.score, 0.5) << seed;
    EXPECT_NE(result.reason().find("mirrors beside it map the shape nearly as well"),
              std::string::npos)
        << seed << ' ' << result.reason();
    EXPECT_EQ(match(posed, *result.mirror).verdict(), "none") << seed;
  }
}

// A surface whose sides have different triangles, the vertices of one crowded at an end.
TEST(Verdict, OfAMeshIsThatOfItsSurface) {
  TestMesh mesh;
  const auto add_side = [&](int rows, double power, double side) {
    constexpr int columns = 9;
    Points points(rows * columns, 3);
    std::vector<std::array<Index, 3>> faces;
    for (Index i = 0; i < points.rows(); ++i) {
      const double u = std::pow(static_cast<double>(i / columns) / (rows - 1), power);
      const double z = 2 * u - 1, r = std::sqrt(std::max(0.0, 1 - z * z)) * (1 + 0.3 * z);
      const double angle =
          std::numbers::pi * (static_cast<double>(i % columns) / (columns - 1) - 0.5);
      points.row(i) << side * r * std::cos(angle), 0.6 * r * std::sin(angle) + 0.15 * z * z, 3 * z;
      if (i < columns || i % columns == 0) continue;
      faces.push_back({i - columns - 1, i - 1, i});
      faces.push_back({i - columns - 1, i, i - columns});
    }
    mesh.add(points, rows_of(faces));
  };
  add_side(9, 1, 1);
  add_side(40, 3, -1);
  const Result found = detected(mesh, "plane");
  const Result matched =
      match(mesh.vertices, *found.mirror, 0.05, {}, false, usual_tolerance, mesh.faces);
  EXPECT_EQ(found.verdict(), "found");
  EXPECT_EQ(matched.verdict(), "found");
  EXPECT_NEAR(matched.score, found.score, 1e-12);
  EXPECT_EQ(matched.pairs, found.pairs);
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
  expect_error<InvalidParameter>("tolerance is 0.5; allowed is real [0.0001, 0.1]", [] {
    match(RandomCloud(0).box(50), Plane(Vector3::UnitX(), 0), 0.05, {}, false, 0.5);
  });
}

}  // namespace
}  // namespace symsurf::verdict_tests
