#include <gtest/gtest.h>
#include <symsurf/detect.h>
#include <symsurf/mirrors.h>

#include <cmath>
#include <functional>
#include <vector>

#include "random_cloud.h"

namespace symsurf::fixed_direction_tests {
namespace {

double ripple(double x, double y) { return std::sin(0.7 * x) * std::cos(0.7 * y); }
double cone(double x, double y) { return std::hypot(x, y); }
double hemisphere(double x, double y) { return std::sqrt(9 - x * x - y * y); }

// A surface and its image over the graph of `mirror`, along z, then turned at random.
struct Surfaces {
  template <typename Mirror, typename Gap>
  Surfaces(std::uint64_t seed, Index pairs, const Mirror& mirror, const Gap& gap)
      : random(seed), rotation(random.rotation()), points(2 * pairs, 3), truth(pairs, 3) {
    for (Index i = 0; i < pairs; ++i) {
      const double x = random.uniform(-2, 2), y = random.uniform(-2, 2);
      const double z = mirror(x, y), d = gap(x, y);
      points.row(2 * i) = (rotation * Vector3(x, y, z + d)).transpose();
      points.row(2 * i + 1) = (rotation * Vector3(x, y, z - d)).transpose();
      truth.row(i) = (rotation * Vector3(x, y, z)).transpose();
    }
  }
  RandomCloud random;
  Matrix3 rotation;
  Points points, truth;
};

double wide(double x, double y) { return 0.9 + 0.2 * std::sin(x + 1) + 0.15 * std::cos(y); }
double narrow(double x, double) { return 0.35 + 0.1 * std::sin(2 * x); }

Result found(const Points& points) {
  Options options;
  options.method = "fixed_direction";
  return detect(points, options);
}

double farthest_foot(const Result& result, const Points& truth) {
  return (result.mirror->project(truth) - truth).rowwise().norm().maxCoeff();
}

TEST(FixedDirection, IsExactWherePartnersAre) {
  for (const auto& mirror : {ripple, cone, hemisphere})
    for (const auto& gap : {wide, narrow})
      for (std::uint64_t seed = 0; seed < seeds; ++seed) {
        const Surfaces surfaces(seed, 300, mirror, gap);
        const Result result = found(surfaces.points);
        EXPECT_LE(farthest_foot(result, surfaces.truth), 1e-9);
        EXPECT_EQ(result.pairs.rows(), surfaces.points.rows());
        for (Index k = 0; k < result.pairs.rows(); ++k)
          EXPECT_EQ(result.pairs(k, 0) / 2, result.pairs(k, 1) / 2);
        EXPECT_LE(result.residuals.maxCoeff(), 1e-9);
      }
}

// It searches on a sixth of them, drawn with their images.
TEST(FixedDirection, IsExactOfManyPointsOverAPlane) {
  const auto flat = [](double, double) { return 0.0; };
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    const Surfaces surfaces(seed, 15000, flat, wide);
    const Result result = found(surfaces.points);
    EXPECT_LE(farthest_foot(result, surfaces.truth), 1e-9) << seed;
    EXPECT_EQ(std::get<double>(result.statistics.at("exact_share")), 1) << seed;
  }
}

Points kept(const Surfaces& surfaces, const std::function<bool(Index)>& keep) {
  std::vector<Index> rows;
  for (Index i = 0; i < surfaces.points.rows(); ++i)
    if (keep(i)) rows.push_back(i);
  return surfaces.points(rows, Eigen::indexing::all);
}

double rms_height(const Surfaces& surfaces, const Points& surface) {
  double sum = 0;
  for (const auto& row : surface.rowwise()) {
    const Vector3 x = surfaces.rotation.transpose() * row.transpose();
    sum += std::pow(x.z() - ripple(x.x(), x.y()), 2);
  }
  return std::sqrt(sum / surface.rows());
}

// Chance has no exact partners: nothing is taken off the score of those that are left.
TEST(FixedDirection, IsSureOfExactPartnersBesideAHole) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    const Surfaces surfaces(seed, 500, ripple, wide);
    const Vector3 centre = surfaces.points.row(0).transpose();
    const Result result = found(kept(surfaces, [&](Index i) {
      return i % 2 || (surfaces.points.row(i).transpose() - centre).norm() > 1.2;
    }));
    EXPECT_GE(result.score, 0.5) << seed;
    EXPECT_LE(rms_height(surfaces, result.surface_points), 0.003) << seed;
  }
}

TEST(FixedDirection, PairsNeighboursWherePartnersAreLost) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    Surfaces surfaces(seed, 500, ripple, wide);
    const Points left = kept(surfaces, [&](Index) { return surfaces.random.uniform(0, 1) < 0.7; });
    const Result result = found(left);
    EXPECT_GE(result.pairs.rows(), 0.85 * left.rows()) << seed;
    EXPECT_LE(rms_height(surfaces, result.surface_points), 0.006) << seed;
  }
}

// A grid as fine as the surfaces over all that lies between would take all memory.
TEST(FixedDirection, StandsAPointFarFromAllOthers) {
  for (const double away : {1e2, 1e4, 1e6}) {
    Points points = RandomCloud(1).box(300);
    points.row(0) *= away;
    EXPECT_NO_THROW(found(points)) << away;
  }
}

TEST(FixedDirection, PairsAClosedShapeNested) {
  // A torus and its image overlap: lines along z meet up to eight surfaces.
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    RandomCloud random(seed);
    const Matrix3 rotation = random.rotation();
    const Index pairs = 400;
    Points points(2 * pairs, 3), truth(pairs, 3);
    for (Index i = 0; i < pairs; ++i) {
      const double a = random.uniform(0, 2 * M_PI), b = random.uniform(0, 2 * M_PI);
      const double r = 1 + 0.4 * std::cos(b);
      const Vector3 x(r * std::cos(a), r * std::sin(a), 0.4 * std::sin(b) + 0.3);
      const Vector3 foot(x.x(), x.y(), ripple(x.x(), x.y()));
      points.row(2 * i) = (rotation * x).transpose();
      points.row(2 * i + 1) = (rotation * (2 * foot - x)).transpose();
      truth.row(i) = (rotation * foot).transpose();
    }
    EXPECT_LE(farthest_foot(found(points), truth), 1e-9);
  }
}

TEST(FixedDirection, SmoothsNoise) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    Surfaces surfaces(seed, 1000, ripple, wide);
    const double diagonal = 6;
    for (auto row : surfaces.points.rowwise())
      row +=
          0.01 * diagonal * surfaces.random.uniform(0, 1) * surfaces.random.direction().transpose();
    const Result result = found(surfaces.points);
    const Points feet = result.mirror->project(surfaces.truth);
    const double rms = (feet - surfaces.truth).norm() / std::sqrt(feet.rows());
    EXPECT_LE(rms / diagonal, 0.003) << "seed " << seed;
  }
}

TEST(FixedDirection, DoesNotDependOnPoseUnitOrderOrThreads) {
  Surfaces surfaces(3, 400, ripple, wide);
  const Result result = found(surfaces.points);
  const Matrix3 rotation = surfaces.random.rotation();
  const Vector3 shift = 50 * surfaces.random.in_box();
  Points moved = 1000 * surfaces.points.colwise().reverse() * rotation.transpose();
  moved.rowwise() += shift.transpose();
  Options options;
  options.method = "fixed_direction";
  const Result other = detect(moved, options, Context(nullptr, 1));
  for (Index i = 0; i < surfaces.truth.rows(); ++i) {
    const Vector3 x = surfaces.truth.row(i).transpose();
    const Vector3 expected = 1000 * (rotation * result.mirror->foot(x)) + shift;
    EXPECT_LE((other.mirror->foot(1000 * (rotation * x) + shift) - expected).norm(), 1e-5);
  }
}

TEST(FixedDirection, TakesAGivenDirection) {
  const Surfaces surfaces(5, 300, ripple, wide);
  Options options;
  options.method = "fixed_direction";
  options.parameters["direction"] = Vector3(-2 * surfaces.rotation.col(2));
  EXPECT_LE(farthest_foot(detect(surfaces.points, options), surfaces.truth), 1e-9);
}

}  // namespace
}  // namespace symsurf::fixed_direction_tests
