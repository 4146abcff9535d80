// Points that crowd and surfaces that cross: they take about as long as as many points elsewhere.
#include <gtest/gtest.h>
#include <symsurf/analyses.h>
#include <symsurf/detect.h>

#include <cmath>
#include <ctime>
#include <numbers>

#include "cloud/exact_isometries.h"
#include "random_cloud.h"

namespace symsurf::crowded_points_tests {
namespace {

// Of one processor.
template <typename Run>
double seconds_of(const Run& run) {
  const std::clock_t start = std::clock();
  run();
  return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
}

// As many points about each of the middles, in turn.
Points crowds_about(const Points& middles, Index count, double width, RandomCloud& random) {
  Points points = width * random.box(count);
  for (Index i = 0; i < count; ++i) points.row(i) += middles.row(i % middles.rows());
  return points;
}

std::size_t isometries(const Points& points) {
  return exact_isometries(points, PointTree(points), {}).maps.size();
}

TEST(CrowdedPoints, HaveTheIsometriesOfTheirMiddles) {
  RandomCloud random(0);
  Points middles(3, 3);  // an isosceles triangle: C2v
  middles << -1, 0, 0, 1, 0, 0, 0, 3, 0;
  const Points crowds = crowds_about(middles, 600, 1e-9, random);
  Points prism(600, 3);  // of 300 sides: D300h
  for (Index i = 0; i < prism.rows(); ++i) {
    const double angle = 2 * std::numbers::pi * static_cast<double>(i / 2) / 300;
    prism.row(i) << std::cos(angle), std::sin(angle), static_cast<double>(i % 2);
  }
  const double usual = seconds_of([&] { EXPECT_EQ(isometries(prism), 1200u); });
  const double taken = seconds_of([&] { EXPECT_EQ(isometries(crowds), 4u); });
  EXPECT_LT(taken, usual);
}

TEST(CrowdedPoints, HaveSmallDiscsWhereSurfacesCross) {
  RandomCloud random(1);
  const Points crossing = random.box(10'000);  // everywhere
  Points sheet = random.box(10'000);
  for (Index i = 0; i < sheet.rows(); ++i)
    sheet(i, 2) = 0.2 * std::sin(3 * sheet(i, 0)) + 0.15 * std::cos(4 * sheet(i, 1) + sheet(i, 0));
  const auto seconds = [&](const Points& points) {
    return seconds_of([&] { analyse("partial_symmetries", points, {}, Context(nullptr, 1)); });
  };
  EXPECT_LT(seconds(crossing), 40 * seconds(sheet));
}

TEST(CrowdedPoints, HaveAFewPartsComparedThatRecur) {
  RandomCloud random(2);
  Points corners(4, 3);
  corners << -2, -1, 0, 2, -1, 0, -2, 1, 0, 2, 1, 0;
  const Points spread = random.box(1500), crowds = crowds_about(corners, 1500, 1e-8, random);
  Triangles faces(2200, 3);
  for (Index f = 0; f < faces.rows(); ++f)
    for (int c = 0; c < 3; ++c) faces(f, c) = static_cast<std::int32_t>(random.below(1500));
  AnalysisOptions options;
  options.faces = faces;
  const auto seconds = [&](const Points& points) {
    return seconds_of([&] { analyse("recurring_parts", points, options, Context(nullptr, 1)); });
  };
  EXPECT_LT(seconds(crowds), 25 * seconds(spread));
}

TEST(CrowdedPoints, HaveAFewSpheresRefined) {
  RandomCloud random(0);
  Points spread = random.box(800), corners(8, 3);
  spread.col(0).setZero();
  corners << 0, -0.6, 0.24, 0, -0.6, -0.24, 0, -0.31, 0.46, 0, -0.31, -0.46, 0, -0.08, 0.83, 0,
      -0.08, -0.83, 0, 0.29, 0.4, 0, 0.29, -0.4;
  const Points crowds = crowds_about(corners, 800, 1e-5, random);
  const auto seconds = [&](const Points& points) {
    return seconds_of([&] { detect(points, {.method = "sphere"}, Context(nullptr, 1)); });
  };
  EXPECT_LT(seconds(crowds), 10 * seconds(spread));
}

}  // namespace
}  // namespace symsurf::crowded_points_tests
