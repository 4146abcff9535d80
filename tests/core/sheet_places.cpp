#include "sheet_places.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "cloud.h"
#include "random_cloud.h"

namespace symsurf {
namespace {

// A ball's surface with noise along its radius: how far what is left of it lies off the surface,
// over the cloud's size; the mean tells of a bias.
struct Ball {
  static constexpr double deviation = 0.01;
  double mean_off = 0, typical_off = 0;

  Ball(std::uint64_t seed, NoiseIs noise) {
    std::mt19937_64 random(seed);
    Points points = RandomCloud(seed).sphere(8000);
    const double size = checked_cloud(points, {}, 4, {}).frame.size;
    std::normal_distribution<double> normal(0, deviation * size);
    for (Index i = 0; i < points.rows(); ++i) points.row(i) *= 1 + normal(random);
    const Cloud cloud = checked_cloud(points, {}, 4, {});
    const Surfels coarse(cloud, 400, {}), fine(cloud, coarse, {});
    const SheetNoise measured({{Vector3::Zero(), &fine[0]}}, {0.67 * deviation * fine[0].normal},
                              fine);
    const SheetPlaces places(coarse, fine, measured, cloud.total);
    for (Index i = 0; i < points.rows(); ++i) {
      const Vector3 x = cloud.frame.enter(points.row(i).transpose());
      const double off =
          (cloud.frame.leave(places.at(x, noise).place).norm() - 1) / cloud.frame.size;
      mean_off += off / static_cast<double>(points.rows());
      typical_off += off * off / static_cast<double>(points.rows());
    }
    typical_off = std::sqrt(typical_off);
  }
};

TEST(SheetPlaces, AreThePointsWhereNoiseIsKept) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed)
    EXPECT_NEAR(Ball(seed, NoiseIs::kept).typical_off, Ball::deviation, 0.1 * Ball::deviation)
        << seed;
}

TEST(SheetPlaces, LieOnTheSurfaceWhereExtrapolatedAndInsideOfItWhereSmoothed) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    const Ball smoothed(seed, NoiseIs::smoothed), extrapolated(seed, NoiseIs::extrapolated);
    EXPECT_LT(smoothed.mean_off, -0.002) << seed;
    EXPECT_NEAR(extrapolated.mean_off, 0, 0.0005) << seed;
    EXPECT_LT(extrapolated.typical_off, 0.4 * Ball::deviation) << seed;
  }
}

}  // namespace
}  // namespace symsurf
