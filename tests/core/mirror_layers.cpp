#include "score/mirror_layers.h"

#include <gtest/gtest.h>

#include <cmath>

#include "random_cloud.h"

namespace symsurf::mirror_layers_tests {
namespace {

constexpr Index count = 2000;
constexpr double apart = 0.05, size = 3.4;

// Points as normal and position, mirrored in z = 0.
template <typename Draw>
double single_layer(const Draw& draw) {
  MirrorLayers layers(apart, 0, size);
  for (Index i = 0; i < count; ++i) {
    const auto [x, normal] = draw(i);
    layers.add(x, normal, Vector3(x.x(), x.y(), -x.z()));
  }
  return layers.single();
}

TEST(MirrorLayers, AreSingleInABall) {
  RandomCloud random(1);
  EXPECT_GT(single_layer([&](Index) {
              const Vector3 x = random.direction();
              return std::pair(x, x);
            }),
            0.9);
}

TEST(MirrorLayers, AreManyInABallWithinABall) {
  RandomCloud random(2);
  EXPECT_EQ(single_layer([&](Index i) {
              const Vector3 x = random.direction();
              return std::pair(Vector3((i % 2 ? 1 : 0.5) * x), x);
            }),
            0);
}

// As the letter C on its back stands with four crossings over a position.
TEST(MirrorLayers, AreManyInARingThatStandsOnTheMirror) {
  RandomCloud random(3);
  EXPECT_EQ(
      single_layer([&](Index) {
        const double around = random.uniform(0, 2 * M_PI), across = random.uniform(0, 2 * M_PI);
        const Vector3 outwards(std::cos(around), 0, std::sin(around));
        const Vector3 normal = std::cos(across) * outwards + std::sin(across) * Vector3::UnitY();
        return std::pair(Vector3(0.7 * outwards + 0.3 * normal), normal);
      }),
      0);
}

// Their mirror could be placed as freely, but nothing closes around it.
TEST(MirrorLayers, DoNotCountWhereNothingCrosses) {
  RandomCloud random(4);
  EXPECT_EQ(single_layer([&](Index i) {
              const Vector3 x = random.in_box();
              return std::pair(Vector3(x.x(), x.y(), i % 2 ? 0.3 : -0.3), Vector3(0, 0, 1));
            }),
            0);
}

TEST(MirrorLayers, OfNothingAreNone) { EXPECT_EQ(MirrorLayers(apart, 0, size).single(), 0); }

}  // namespace
}  // namespace symsurf::mirror_layers_tests
