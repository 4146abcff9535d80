// Points that are not finite are left out, counted, and have no partners.

#include <gtest/gtest.h>
#include <symsurf/symsurf.h>

#include <cmath>
#include <limits>
#include <vector>

#include "expect_error.h"
#include "mirrored_ball.h"
#include "random_cloud.h"

namespace symsurf {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// Every seventh row is put in front of the others: the rows of the finite points.
std::vector<Index> finite_rows_of(Index count) {
  std::vector<Index> rows;
  for (Index i = 0; static_cast<Index>(rows.size()) < count; ++i)
    if (i % 7 != 3) rows.push_back(i);
  return rows;
}

Points spread(const Points& points, const std::vector<Index>& rows) {
  Points all(rows.back() + 1, 3);
  for (Index i = 0; i < all.rows(); ++i)
    all.row(i) << (i % 3 ? std::nan("") : infinity), -infinity, 1;
  for (std::size_t k = 0; k < rows.size(); ++k) all.row(rows[k]) = points.row(k);
  return all;
}

void expect_the_same(const Result& with, const Result& without, const std::vector<Index>& rows,
                     Index left_out) {
  EXPECT_EQ(std::get<Index>(with.statistics.at("nonfinite_points")), left_out);
  EXPECT_EQ(without.statistics.count("nonfinite_points"), 0u);
  EXPECT_EQ(with.score, without.score);
  EXPECT_EQ(with.residuals, without.residuals);
  EXPECT_EQ(with.surface_points, without.surface_points);
  ASSERT_EQ(with.pairs.rows(), without.pairs.rows());
  for (Index row = 0; row < with.pairs.rows(); ++row)
    for (const Index side : {0, 1})
      ASSERT_EQ(with.pairs(row, side), rows[without.pairs(row, side)]);
}

TEST(NonfinitePoints, ChangeNothingButTheirNumber) {
  RandomCloud random(1);
  const Points points = ball(random, 300);
  const std::vector<Index> rows = finite_rows_of(points.rows());
  const Points all = spread(points, rows);
  const Index left_out = all.rows() - points.rows();
  for (const Method& method : methods()) {
    SCOPED_TRACE(method.name);
    const Result without = detect(points, {.method = method.name});
    const Result with = detect(all, {.method = method.name});
    expect_the_same(with, without, rows, left_out);
    ASSERT_EQ(!with.mirror, !without.mirror);
    if (with.mirror) {
      EXPECT_EQ(with.mirror->numbers(), without.mirror->numbers());
    }
    EXPECT_EQ(with.verdict(), without.verdict());
    if (without.statistics.count("unpaired_points")) {
      EXPECT_EQ(std::get<Index>(with.statistics.at("unpaired_points")),
                std::get<Index>(without.statistics.at("unpaired_points")) + left_out);
    }
  }
  const Plane mirror(Vector3::UnitX(), 0);
  expect_the_same(match(all, mirror), match(points, mirror), rows, left_out);
}

TEST(NonfinitePoints, GoWithTheirNormals) {
  RandomCloud random(2);
  const Points points = ball(random, 400), normals = random.sphere(400);
  const std::vector<Index> rows = finite_rows_of(points.rows());
  const Points all = spread(points, rows), all_normals = spread(normals, rows);
  for (const char* method : {"normals_only", "separation_normals", "plane"}) {
    SCOPED_TRACE(method);
    expect_the_same(detect(all, {.method = method, .normals = all_normals}),
                    detect(points, {.method = method, .normals = normals}), rows,
                    all.rows() - points.rows());
  }
  // Of finite points they must be directions, and errors name the rows of the input.
  for (const double bad : {0.0, std::nan(""), infinity}) {
    Points broken = all_normals;
    broken.row(rows[50]) << 0, 0, bad;
    expect_error<InvalidInput>("normal " + std::to_string(rows[50]) + " is (0, 0, ",
                               [&] { detect(all, {.method = "plane", .normals = broken}); });
  }
  expect_error<InvalidInput>("400 normals given for " + std::to_string(all.rows()) + " points",
                             [&] { detect(all, {.method = "plane", .normals = normals}); });
}

TEST(NonfinitePoints, WithOutliers) {
  RandomCloud random(3);
  Points points(1010, 3);
  points << 200 * random.sphere(10), ball(random, 1000);
  const std::vector<Index> rows = finite_rows_of(points.rows());
  const Points all = spread(points, rows);
  const Result with = detect(all, {.method = "plane"});
  EXPECT_EQ(std::get<Index>(with.statistics.at("outliers")), 10);
  expect_the_same(with, detect(points, {.method = "plane"}), rows, all.rows() - points.rows());
}

TEST(NonfinitePoints, TooFewAreFinite) {
  RandomCloud random(4);
  Points points = random.box(50);
  for (Index i = 3; i < 50; ++i) points(i, i % 3) = i % 2 ? std::nan("") : infinity;
  for (const Method& method : methods())
    expect_error<InvalidInput>("3 of 50 points given are finite; at least " +
                                   std::to_string(method.minimum_points) + " are needed",
                               [&] { detect(points, {.method = method.name}); });
  points.setConstant(infinity);
  expect_error<InvalidInput>("0 of 50 points given are finite; at least 1 is needed",
                             [&] { match(points, Plane(Vector3::UnitX(), 0)); });
}

}  // namespace
}  // namespace symsurf
