#include <gtest/gtest.h>
#include <symsurf/context.h>
#include <symsurf/detect.h>
#include <symsurf/points.h>

#include "expect_error.h"
#include "thesis_clouds.h"
#include "thesis_oracle.h"

namespace symsurf::thesis_methods_tests {
namespace {

constexpr std::uint64_t clouds = 240;
constexpr double rounding = 1e-12;

Result run(const Points& points, const char* method, const Values& parameters = {}) {
  Options options;
  options.method = method;
  options.parameters = parameters;
  return detect(points, options);
}

void expect_pairs(const Result& result, const oracle::Trial& trial, PointsView points) {
  ASSERT_EQ(result.pairs.rows(), static_cast<Index>(trial.x.size()));
  for (Index k = 0; k < result.pairs.rows(); ++k) {
    EXPECT_EQ(result.pairs(k, 0), trial.x[k]);
    EXPECT_EQ(result.pairs(k, 1), trial.b[k]);
    EXPECT_NEAR(result.residuals[k], std::sqrt(trial.squared[k]), rounding);
    const Vector3 midpoint = (points[trial.x[k]] + points[trial.b[k]]) / 2;
    EXPECT_EQ(Vector3(result.surface_points.row(k)), midpoint);
  }
}

// Every direction tried, the best of them and its pairs.
void expect_trials(const Result& result, PointsView points, const Points* normals, bool as_lines) {
  const auto& table = std::get<Eigen::MatrixXd>(result.statistics.at("directions"));
  const std::vector<Vector3> directions = oracle::directions();
  ASSERT_EQ(table.rows(), 91);
  ASSERT_EQ(directions.size(), 91u);
  oracle::Trial best;
  best.score = -1;
  Index skipped = 0;
  for (Index k = 0; k < table.rows(); ++k) {
    const oracle::Trial trial = oracle::trial(points, directions[k], normals, as_lines);
    EXPECT_NEAR((Vector3(table.row(k).head<3>()) - trial.direction).norm(), 0, rounding);
    EXPECT_EQ(table(k, 6), static_cast<double>(trial.x.size()));
    EXPECT_EQ(table(k, 7), static_cast<double>(trial.lower));
    if (trial.x.empty() || trial.lower == 0) {
      ++skipped;
      EXPECT_TRUE(std::isnan(table(k, 5)));
      continue;
    }
    EXPECT_NEAR(table(k, 3), trial.error, rounding);
    EXPECT_NEAR(table(k, 4), trial.clearance, rounding);
    EXPECT_NEAR(table(k, 5), trial.score, rounding);
    if (trial.score > best.score) best = trial;
  }
  EXPECT_EQ(std::get<Index>(result.statistics.at("skipped_directions")), skipped);
  EXPECT_NEAR(std::get<double>(result.statistics.at("thesis_score")), best.score, rounding);
  // Scores that differ by rounding only may each win; then the pairs are those of the winner.
  const Vector3 winner = std::get<Vector3>(result.statistics.at("direction"));
  expect_pairs(result, oracle::trial(points, winner, normals, as_lines), points);
}

TEST(Separation, MatchesBruteForce) {
  for (std::uint64_t seed = 0; seed < clouds; ++seed) {
    SCOPED_TRACE(seed);
    const Points points = ascending(thesis_cloud(seed));
    expect_trials(run(points, "separation"), points, nullptr, true);
  }
}

TEST(SeparationNormals, MatchesBruteForce) {
  for (std::uint64_t seed = 0; seed < clouds; ++seed) {
    SCOPED_TRACE(seed);
    const Points points = ascending(thesis_cloud(seed));
    const char* estimation = seed % 2 ? "pca" : "regression";
    const Points normals = estimate_normals(points, 10, estimation);
    expect_trials(run(points, "separation_normals", {{"normal_estimation", estimation}}), points,
                  &normals, seed % 2);
  }
}

TEST(NormalsOnly, MatchesBruteForce) {
  for (std::uint64_t seed = 0; seed < clouds; ++seed) {
    SCOPED_TRACE(seed);
    const Points points = ascending(thesis_cloud(seed));
    const char* estimation = seed % 2 ? "pca" : "regression";
    const Points normals = estimate_normals(points, 10, estimation);
    expect_pairs(run(points, "normals_only", {{"normal_estimation", estimation}}),
                 oracle::along_normals(points, normals), points);
  }
}

// Chords in the middle of the sweep's range, where strips and runs matter.
TEST(Separation, MatchesBruteForceOnLargerClouds) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    SCOPED_TRACE(seed);
    RandomCloud random(seed);
    Points points = random.box(1500);
    points.topRows(700) *= 0.01;
    const Result result = run(points, "separation");
    const Vector3 direction = std::get<Vector3>(result.statistics.at("direction"));
    expect_pairs(result, oracle::trial(points, direction), points);
  }
}

TEST(NormalsOnly, MatchesBruteForceOnLargerClouds) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    SCOPED_TRACE(seed);
    RandomCloud random(seed);
    const Points points = ascending(random.lattice(1500, 9));
    const Points normals = estimate_normals(points, 10, "regression");
    expect_pairs(run(points, "normals_only"), oracle::along_normals(points, normals), points);
  }
}

// A surface mirrored along z, one of the directions tried (Table 5.1: 1e-7 in single precision).
TEST(Separation, FindsAMirrorAlongOneOfItsDirections) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    SCOPED_TRACE(seed);
    RandomCloud random(seed);
    constexpr Index n = 500;
    const auto surface = [](double x, double y) { return std::sin(0.7 * x) * std::cos(0.7 * y); };
    Points points(2 * n, 3);
    for (Index i = 0; i < n; ++i) {
      const double x = random.uniform(-2, 2), y = random.uniform(-2, 2);
      const double z = 3 + 0.3 * std::sin(2 * x) * y;
      points.row(i) << x, y, z;
      points.row(n + i) << x, y, 2 * surface(x, y) - z;
    }
    const Result result = run(points, "separation");
    EXPECT_EQ(std::get<Vector3>(result.statistics.at("direction")), Vector3::UnitZ());
    ASSERT_EQ(result.surface_points.rows(), n);
    for (const auto& y : result.surface_points.rowwise())
      EXPECT_NEAR(y.z(), surface(y.x(), y.y()), rounding);
    EXPECT_GT(result.score, 0.9);
  }
}

TEST(NormalsOnly, TakesGivenNormalsAsTheyAre) {
  // Two parallel squares; with tilted normals no partner lies straight above.
  RandomCloud random(1);
  constexpr Index n = 50;
  Points points(2 * n, 3), normals(2 * n, 3);
  for (Index i = 0; i < n; ++i) {
    const Vector3 x(random.uniform(0, 1), random.uniform(0, 1), 0);
    points.row(i) = x.transpose();
    points.row(n + i) = (x + Vector3::UnitZ()).transpose();
    normals.row(i) << 0, 0, 5;
    normals.row(n + i) << 0, 0, -1e-3;
  }
  Options options;
  options.method = "normals_only";
  options.normals = normals;
  const Result result = detect(points, options);
  for (Index i = 0; i < n; ++i) {
    EXPECT_EQ(result.pairs(i, 1), n + i);
    EXPECT_EQ(result.pairs(n + i, 1), i);
  }
  EXPECT_EQ(result.residuals.maxCoeff(), 0);
}

TEST(SeparationNormals, NeedsAsManyPointsAsNeighbours) {
  RandomCloud random(1);
  const Points points = random.box(9);
  for (const char* method : {"separation_normals", "normals_only"})
    expect_error<InvalidInput>("10", [&] { run(points, method); });
}

TEST(ThesisMethods, GiveTheSameBitsForAnyNumberOfThreads) {
  RandomCloud random(3);
  const Points points = random.box(2000);
  for (const char* name : {"separation", "separation_normals", "normals_only", "sphere_thesis"}) {
    Options options;
    options.method = name;
    if (options.method == "sphere_thesis") options.parameters = {{"sample_size", Index{90}}};
    const Result one = detect(points, options, Context({}, 1));
    const Result three = detect(points, options, Context({}, 3));
    EXPECT_EQ(one.pairs, three.pairs) << name;
    EXPECT_EQ(one.residuals, three.residuals) << name;
    EXPECT_EQ(one.score, three.score) << name;
  }
}

// Six points of one plane, 1e-28 wide, whose measure is a rounding error above their number.
TEST(SphereThesis, ScoresAtMostOne) {
  Points points(6, 3);
  points << 4.9274023414673167e-29, -1.9, 3.8272984706565296e-29,  //
      2.8727375112394714e-30, -1.9, -4.249137895496765e-31,        //
      -2.9562399135342484e-29, -1.9, 9.519862246104513e-29,        //
      6.14751770584071e-29, -1.9, 6.391096195323864e-29,           //
      6.585292145985101e-29, -1.9, 2.1487692430558894e-29,         //
      8.733879390239066e-29, -1.9, 9.908000198135558e-30;
  EXPECT_LE(run(points, "sphere_thesis").score, 1);
}

TEST(SphereThesis, WarnsOfMorePointsThanItIsFor) {
  const Points points = RandomCloud(1).box(10'001);
  const auto detected = [&](Index count) {
    const Options options{.method = "sphere_thesis", .parameters = {{"sample_size", Index{10}}}};
    return detect(Points(points.topRows(count)), options).statistics;
  };
  EXPECT_EQ(detected(10'000).count("warning"), 0u);
  const Values statistics = detected(10'001);
  ASSERT_EQ(statistics.count("warning"), 1u);
  EXPECT_EQ(std::get<std::string>(statistics.at("warning")).find("10001 points given"), 0u);
}

}  // namespace
}  // namespace symsurf::thesis_methods_tests
