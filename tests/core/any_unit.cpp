#include <gtest/gtest.h>
#include <symsurf/detect.h>
#include <symsurf/mirrors.h>

#include <cmath>

#include "cloud/point_tree.h"
#include "random_cloud.h"

namespace symsurf::any_unit_tests {
namespace {

// Two wavy surfaces mirrored in z at a distance that varies, no point exactly opposite another.
Points surfaces(Index count) {
  RandomCloud random(1);
  Points points = random.box(count);
  for (Index i = 0; i < count; ++i) {
    const double x = points(i, 0), y = points(i, 1);
    points(i, 2) = (i % 2 ? 1 : -1) * (0.3 + 0.1 * std::sin(3 * x) * std::cos(2 * y));
  }
  return points;
}

// Powers of two scale without rounding: what differs then is due to the unit.
TEST(AnyUnit, EveryMethodFindsTheSame) {
  for (const Method& method : methods()) {
    const Points points =
        surfaces(method.name == "plane" ? 25000 : 600);  // it asks a grid of fewer
    Options options{.method = method.name};
    if (method.name == "sphere_thesis") options.parameters = {{"sample_size", Index{40}}};
    const Result one = detect(points, options);
    for (const int power : {-150, 150}) {
      const double unit = std::ldexp(1, power);
      const Result other = detect(Points(unit * points), options);
      EXPECT_NEAR(other.score, one.score, 1e-6) << method.name << " in 2^" << power;
      EXPECT_EQ(other.pairs.rows(), one.pairs.rows()) << method.name << " in 2^" << power;
      ASSERT_EQ(!other.mirror, !one.mirror) << method.name << " in 2^" << power;
      if (!one.mirror) continue;
      const Points feet = one.mirror->project(points);
      const Points others = other.mirror->project(Points(unit * points)) / unit;
      for (Index i = 0; i < feet.rows(); ++i)  // a free form has not all of them
        EXPECT_TRUE((others.row(i) - feet.row(i)).norm() <= 1e-6 ||
                    (!feet.row(i).allFinite() && !others.row(i).allFinite()))
            << method.name << " in 2^" << power << " at " << i;
    }
  }
}

TEST(AnyUnit, TreesFindWhatIsFarFromThem) {
  const Points points = RandomCloud(2).box(2000);
  for (const int power : {-160, 0, 160}) {
    const PointTree tree(Points(std::ldexp(1, power) * points));
    for (const double far : {1e12, 1e20, 1e60}) {
      const double away = std::ldexp(far, power);
      const Neighbour found = tree.nearest({away, 0, 0});
      ASSERT_GE(found.index, 0) << far << " in 2^" << power;
      EXPECT_NEAR(std::sqrt(found.squared_distance) / away, 1, 1e-11);
    }
  }
}

TEST(AnyUnit, InterpolatedHeightsEndNowhere) {
  RandomCloud random(3);
  const HeightField field({0, 0, 1}, random.box(100));
  for (const double far : {1e6, 1e20, 1e100})
    EXPECT_TRUE(field.foot(Vector3(far, -far, 0)).allFinite()) << far;
  EXPECT_FALSE(field.foot(Vector3(1e200, 0, 0)).allFinite());
}

}  // namespace
}  // namespace symsurf::any_unit_tests
