#include "score/mirror_sides.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "random_cloud.h"

namespace symsurf::mirror_sides_tests {
namespace {

using Relief = std::function<double(double, double)>;

// Waves of random directions and phases, some three to the unit.
Relief relief(RandomCloud& random, double height) {
  struct Wave {
    double u, v, phase;
  };
  std::vector<Wave> waves;
  for (int k = 0; k < 8; ++k) {
    const double way = random.uniform(0, 2 * M_PI), number = random.uniform(12, 24);
    waves.push_back({number * std::cos(way), number * std::sin(way), random.uniform(0, 2 * M_PI)});
  }
  return [waves, height](double u, double v) {
    double sum = 0;
    for (const Wave& wave : waves) sum += std::cos(wave.u * u + wave.v * v + wave.phase);
    return height * sum / 2;
  };
}

// Of an upper and a lower side over the plane z = 0, as far as a mirror that is bent gently
// follows.
double evidence(RandomCloud& random, const Relief& upper, const Relief& lower) {
  MirrorSides sides(0.06);
  for (int i = 0; i < 600; ++i) {
    const double u = random.uniform(0, 1), v = random.uniform(0, 1);
    const double bend = 0.05 * std::sin(4 * u);
    const double above = 0.2 + upper(u, v), below = 0.2 + lower(u, v);
    const Vector3 normal = (i % 2 ? 1 : -1) * Vector3::UnitZ();
    sides.add({{u, v, bend}, normal, normal.z() * (above - below) / 2, (above + below) / 2});
  }
  return sides.evidence();
}

TEST(MirrorSides, SpeakForAMirrorWhereTheyAreAlike) {
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    RandomCloud random(seed);
    const Relief both = relief(random, 0.02);
    EXPECT_GT(evidence(random, both, both), 30) << seed;
  }
}

TEST(MirrorSides, SpeakForNoneWhereTheyHaveNothingInCommon) {
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    RandomCloud random(seed);
    const Relief upper = relief(random, 0.02), lower = relief(random, 0.02);
    EXPECT_EQ(evidence(random, upper, lower), 0) << seed;
  }
}

// A plate has a middle whatever its shape.
TEST(MirrorSides, OfAPlateSayNothing) {
  RandomCloud random(1);
  const Relief bump = relief(random, 0.02);
  const Relief dent = [&](double u, double v) { return -bump(u, v); };
  EXPECT_EQ(evidence(random, bump, dent), 0);
}

TEST(MirrorSides, OfFewPointsSayNothing) {
  MirrorSides sides(0.06);
  EXPECT_EQ(sides.evidence(), 0);
  for (int i = 0; i < 10; ++i) sides.add({Vector3::UnitX() * i * 0.1, Vector3::UnitZ(), 0, 0.2});
  EXPECT_EQ(sides.evidence(), 0);
}

}  // namespace
}  // namespace symsurf::mirror_sides_tests
