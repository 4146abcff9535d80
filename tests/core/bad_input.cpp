#include <gtest/gtest.h>
#include <symsurf/mirrors.h>
#include <symsurf/symsurf.h>

#include <cmath>
#include <limits>

#include "bad_input/tables.h"
#include "expect_error.h"
#include "random_cloud.h"
#include "temporary_file.h"

namespace symsurf::bad_input_tests {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
const double nan = std::nan("");

// Every way from points to a mirror must refuse the points, with the same words.
void expect_refused(const std::string& error, const Points& points) {
  for (const Method& method : methods())
    expect_error<InvalidInput>(
        error, [&] { detect(points, {.method = method.name, .refuse_nonfinite = true}); });
  expect_error<InvalidInput>(error, [&] { match(points, Plane({1, 0, 0}, 0), 0.05, {}, true); });
}

Points line(const Vector3& from, const Vector3& step, Index n) {
  Points points(n, 3);
  for (Index i = 0; i < n; ++i) points.row(i) = (from + double(i) * step).transpose();
  return points;
}

TEST(BadInput, CloudsOfTheTable) {
  for (const bad_input::Cloud& cloud : bad_input::clouds()) {
    SCOPED_TRACE(cloud.name);
    for (const Method& method : methods())
      expect_error<InvalidInput>(cloud.reason, [&] {
        detect(cloud.points, {.method = method.name, .refuse_nonfinite = cloud.refuses_nonfinite});
      });
  }
}

TEST(BadInput, MirrorsOfTheTable) {
  for (const bad_input::MirrorNumbers& mirror : bad_input::mirrors()) {
    SCOPED_TRACE(mirror.name);
    expect_error<std::invalid_argument>(mirror.reason,
                                        [&] { make_mirror(mirror.kind, mirror.numbers); });
  }
}

TEST(BadInput, FilesOfTheTable) {
  for (const bad_input::File& file : bad_input::files())
    expect_unreadable(file.name, file.content, file.reason);
}

TEST(BadInput, TooFewPoints) {
  const Points three = RandomCloud(0).box(3);
  for (const Method& method : methods()) {
    const std::string needed = "at least " + std::to_string(method.minimum_points);
    expect_error<InvalidInput>("0 points given; " + needed,
                               [&] { detect({}, {.method = method.name}); });
    expect_error<InvalidInput>("3 points given; " + needed,
                               [&] { detect(three, {.method = method.name}); });
  }
  expect_error<InvalidInput>("0 points given", [] { match({}, Plane({1, 0, 0}, 0)); });
}

TEST(BadInput, NotFiniteWhereThatIsRefused) {
  for (const double bad : {nan, infinity, -infinity}) {
    Points points = RandomCloud(0).box(50);
    points(37, 1) = bad;
    expect_refused("point 37 is (", points);
    expect_refused("must be finite", points);
  }
}

TEST(BadInput, AllEqual) {
  expect_refused("all 20 points are equal", Points::Zero(20, 3));
  expect_refused("all 20 points are equal", Points::Constant(20, 3, 4000000.001));
}

TEST(BadInput, AllOnOneLine) {
  expect_refused("all 20 points lie on one line", line({0, 0, 0}, {1, 0, 0}, 20));
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    RandomCloud random(seed);
    for (const double length : {1e-6, 1.0, 1e6})
      expect_refused("lie on one line", line(random.in_box(), length * random.direction(), 20));
  }
}

// A view of more points than there are: nobody may read them.
TEST(BadInput, TooManyPoints) {
  const Points few = RandomCloud(0).box(50);
  const PointsView many(few.data(), (Index{1} << 30) + 1);
  const std::string error =
      "1073741825 points given; at most 1073741824 in one process are allowed";
  for (const Method& method : methods())
    expect_error<InvalidInput>(error, [&] { detect(many, {.method = method.name}); });
  expect_error<InvalidInput>(error, [&] { match(many, Plane({1, 0, 0}, 0)); });
}

TEST(BadInput, BeyondWhatNumbersHold) {
  for (const double size : {1e-200, 1e-60, 1e60, 1e200})
    expect_refused("allowed is 1e-50 to 1e+50", size * RandomCloud(0).box(50));
  const Points points = RandomCloud(0).box(50);
  const double score = detect(points, {.method = "plane"}).score;
  for (const double size : {std::ldexp(1, -160), std::ldexp(1, 160)})
    EXPECT_NEAR(detect(Points(size * points), {.method = "plane"}).score, score, 1e-9);
}

TEST(BadInput, AlmostOnOneLineIsNoError) {
  Points points = line({0, 0, 0}, {1, 0, 0}, 20);
  points.col(1) = 1e-5 * RandomCloud(0).box(20).col(1);
  EXPECT_NO_THROW(match(points, Plane({1, 0, 0}, 0)));
}

TEST(BadInput, UnknownMethodOrParameter) {
  const Points points = RandomCloud(0).box(50);
  expect_error<InvalidParameter>("there is no method 'plan'",
                                 [&] { detect(points, {.method = "plan"}); });
  for (const Method& method : methods()) {
    const std::string error = "'" + method.name + "' has no parameter 'colour'; it has";
    expect_error<InvalidParameter>(error, [&] {
      detect(points, {.method = method.name, .parameters = {{"colour", 1.0}}});
    });
  }
}

TEST(BadInput, ParametersOutOfRange) {
  const Points points = RandomCloud(0).box(50);
  for (const Method& method : methods())
    for (const Parameter& parameter : method.parameters) {
      std::vector<Value> refused{Eigen::MatrixXd(2, 2)};
      const bool is_real = parameter.type == ParameterType::Real;
      if (is_real) refused.push_back(nan);
      for (const double beyond : {parameter.minimum - 1, parameter.maximum + 1})
        if (std::isfinite(beyond) && parameter.minimum < parameter.maximum) {
          if (is_real)
            refused.emplace_back(beyond);
          else
            refused.emplace_back(static_cast<Index>(beyond));
        }
      for (const Value& value : refused)
        expect_error<InvalidParameter>(parameter.name + " is " + to_string(value), [&] {
          detect(points, {.method = method.name, .parameters = {{parameter.name, value}}});
        });
    }
  expect_error<InvalidParameter>("pair_distance is -1; allowed is real [0, inf)", [&] {
    match(points, Plane({1, 0, 0}, 0), -1);
  });
  expect_error<InvalidParameter>("pair_distance is nan", [&] {
    match(points, Plane({1, 0, 0}, 0), nan);
  });
}

TEST(BadInput, NormalsThatAreNone) {
  RandomCloud random(0);
  const Points points = random.box(50), normals = random.sphere(50);
  const auto refused = [&](const std::string& error, const Points& given) {
    for (const Method& method : methods())
      expect_error<InvalidInput>(
          error, [&] { detect(points, {.method = method.name, .normals = given}); });
  };
  refused("49 normals given for 50 points", normals.topRows(49));
  Points broken = normals;
  broken.row(7).setZero();
  refused("normal 7 is (0, 0, 0)", broken);
  broken(7, 2) = nan;
  refused("normal 7 is (0, 0, nan)", broken);
}

}  // namespace
}  // namespace symsurf::bad_input_tests
