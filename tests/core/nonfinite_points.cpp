// Points that are not finite are left out, counted, and have no partners.

#include <gtest/gtest.h>
#include <symsurf/symsurf.h>

#include <cmath>
#include <limits>
#include <vector>

#include "bumpy_ball.h"
#include "expect_error.h"
#include "mirrored_ball.h"
#include "random_cloud.h"

namespace symsurf::nonfinite_points_tests {
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
    Options options{.method = method.name};
    if (method.name == "sphere_thesis") options.parameters = {{"sample_size", Index{40}}};
    const Result without = detect(points, options), with = detect(all, options);
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

// The mesh with points that are not finite between its own, and with a face of these behind each.
Triangles between(const Triangles& faces, const std::vector<Index>& rows) {
  Triangles all(2 * faces.rows(), 3);
  for (Index f = 0; f < faces.rows(); ++f) {
    for (int c = 0; c < 3; ++c) all(2 * f, c) = all(2 * f + 1, c) = rows[faces(f, c)];
    all(2 * f + 1, f % 3) = 3;
  }
  return all;
}

bool is_same(double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); }

struct Pair {
  const OperationResult& with;
  const OperationResult& without;
  const std::vector<Index>& rows;
  Index left_out;

  Index row(Index i) const {
    const auto kept = static_cast<Index>(rows.size());
    return i < kept ? rows[i] : i + left_out;
  }

  void expect_same_array(const PointArray& array) const {
    SCOPED_TRACE(array.name);
    const Eigen::MatrixXd &one = with.arrays.at(array.name), &other = without.arrays.at(array.name);
    const bool same_shape = !without.is_other_shape();
    ASSERT_EQ(one.rows(), with.points.rows());
    for (Index i = 0; i < other.rows(); ++i)
      for (Index k = 0; k < other.cols(); ++k) {
        double expected = other(i, k);
        if (same_shape && expected >= 0 && array.names_points)
          expected = static_cast<double>(row(static_cast<Index>(expected)));
        if (expected >= 0 && array.names_faces) expected *= 2;
        ASSERT_TRUE(is_same(one(same_shape ? row(i) : i, k), expected)) << i;
      }
    if (!same_shape) return;
    const double absent = array.type == ParameterType::Real         ? std::nan("")
                          : array.names_points || array.names_faces ? -1
                                                                    : 0;
    for (Index i = 3; i < rows.back(); i += 7) ASSERT_TRUE(is_same(one(i, 0), absent)) << i;
  }

  void expect_same_points() const {
    if (without.is_other_shape()) {
      EXPECT_EQ(with.points, without.points);
      EXPECT_EQ(with.faces, without.faces);
      ASSERT_EQ(with.point_parents.rows(), without.point_parents.rows());
      for (Index i = 0; i < without.point_parents.size(); ++i)
        ASSERT_EQ(with.point_parents.data()[i], rows[without.point_parents.data()[i]]);
      return;
    }
    ASSERT_EQ(with.points.rows(), without.points.rows() + left_out);
    for (Index i = 0; i < without.points.rows(); ++i)
      ASSERT_EQ(with.points.row(row(i)), without.points.row(i)) << i;
    for (std::size_t i = 0; i < without.point_sources.size(); ++i)
      ASSERT_EQ(with.point_sources[row(static_cast<Index>(i))], rows[without.point_sources[i]]);
  }
};

TEST(NonfinitePoints, KeepTheirPlacesWithoutValuesInOperations) {
  Ball b = ball(0);
  b.points.row(5) *= 1.05;
  const std::vector<Index> rows = finite_rows_of(b.points.rows());
  const Points all = spread(b.points, rows);
  // Half of the ball, so that completion adds the other.
  const Triangles half = b.faces.topRows(b.faces.rows() / 2);
  for (const Operation& each : operations())
    for (const Triangles& faces : {b.faces, half, Triangles(0, 3)}) {
      if (each.needs_faces && faces.rows() == 0) continue;
      SCOPED_TRACE(each.name + " of a shape with faces: " + std::to_string(faces.rows()));
      const OperationResult without = operate(each.name, {b.points, faces}, middle);
      const OperationResult with = operate(each.name, {all, between(faces, rows)}, middle);
      const Index left_out = all.rows() - b.points.rows();
      EXPECT_EQ(std::get<Index>(with.statistics.at("nonfinite_points")), left_out);
      const Pair pair{with, without, rows, left_out};
      pair.expect_same_points();
      for (const PointArray& array : each.arrays)
        if (without.arrays.count(array.name)) pair.expect_same_array(array);
    }
  const Points none = Points::Constant(4, 3, infinity);
  expect_error<InvalidInput>("none of the 4 points given is finite",
                             [&] { operate("align", {none}, middle); });
}

}  // namespace
}  // namespace symsurf::nonfinite_points_tests
