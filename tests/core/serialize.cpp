// What one process found gets to the others to the bit.

#include <gtest/gtest.h>
#include <symsurf/detect.h>

#include <cmath>

#include "processes/processes.h"
#include "random_cloud.h"

namespace symsurf::serialize_tests {

namespace {

void expect_same(const Result& sent, const Result& got) {
  EXPECT_EQ(got.method, sent.method);
  EXPECT_EQ(got.score, sent.score);
  EXPECT_EQ(got.seconds, sent.seconds);
  EXPECT_EQ(got.parameters, sent.parameters);
  EXPECT_EQ(got.statistics, sent.statistics);
  ASSERT_EQ(got.mirror != nullptr, sent.mirror != nullptr);
  if (sent.mirror) {
    EXPECT_EQ(got.mirror->kind(), sent.mirror->kind());
    EXPECT_EQ(got.mirror->numbers(), sent.mirror->numbers());
    EXPECT_EQ(got.mirror->mesh().triangles, sent.mirror->mesh().triangles);
  }
  ASSERT_EQ(got.candidates.size(), sent.candidates.size());
  for (std::size_t i = 0; i < sent.candidates.size(); ++i)
    expect_same(sent.candidates[i], got.candidates[i]);
}

class Serialize : public testing::TestWithParam<const char*> {};

// A bent plate, in many poses.
TEST_P(Serialize, GivesTheSame) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    RandomCloud random(seed);
    Points points(800, 3);
    for (Index i = 0; i < points.rows(); ++i) {
      const double x = random.uniform(-1, 1), y = random.uniform(-1, 1);
      points.row(i) << x, y, 0.2 * x * x + (i % 2 ? 0.3 : -0.3) * (1.2 + std::sin(2 * x + y));
    }
    points *= random.rotation();
    points.rowwise() += random.in_box().transpose();
    Options options;
    options.method = GetParam();
    const Result result = detect(points, options);
    expect_same(result, deserialize(serialize(result)));
  }
}

INSTANTIATE_TEST_SUITE_P(Methods, Serialize,
                         testing::Values("plane", "sphere", "cylinder", "quadric", "perpendicular",
                                         "fixed_direction", "separation"),
                         [](const auto& tested) { return std::string(tested.param); });

TEST(SerializedResult, MayHaveNoMirror) {
  Result result;
  result.method = "plane";
  result.statistics = {{"a", true}, {"b", Index{3}}, {"c", std::string("text")}, {"d", 0.5}};
  expect_same(result, deserialize(serialize(result)));
}

}  // namespace

}  // namespace symsurf::serialize_tests
