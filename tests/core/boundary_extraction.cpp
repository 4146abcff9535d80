#include <gtest/gtest.h>
#include <symsurf/detect.h>
#include <symsurf/mirrors.h>

#include <cmath>

#include "cloud/cloud.h"
#include "cloud/point_tree.h"
#include "cloud/surface_points.h"
#include "preprocess/boundary.h"
#include "random_cloud.h"

namespace symsurf::boundary_extraction_tests {
namespace {

// Inside of two ellipsoids grown together, mirrored by x = 0; each point drawn by itself.
bool is_inside(const Vector3& x) {
  const Vector3 body = x.cwiseQuotient(Vector3(0.5, 1, 0.6));
  const Vector3 limb =
      (x - Vector3(x.x() < 0 ? -0.5 : 0.5, 0.5, 0.4)).cwiseQuotient(Vector3(0.4, 0.3, 0.5));
  return body.squaredNorm() < 1 || limb.squaredNorm() < 1;
}

Points filled(RandomCloud& random, Index count) {
  Points points(count, 3);
  for (Index i = 0; i < count;) {
    const Vector3 x = 1.2 * random.in_box();
    if (is_inside(x)) points.row(i++) = x.transpose();
  }
  return points;
}

// Voxels of the same body, turned.
Points voxels(const Matrix3& turn, double edge) {
  std::vector<Vector3> inside;
  const int most = static_cast<int>(std::ceil(1.8 / edge));
  for (int i = -most; i <= most; ++i)
    for (int j = -most; j <= most; ++j)
      for (int k = -most; k <= most; ++k) {
        const Vector3 x(i, j, k);
        if (is_inside(turn.transpose() * x * edge)) inside.push_back(x);
      }
  Points points(static_cast<Index>(inside.size()), 3);
  for (Index i = 0; i < points.rows(); ++i) points.row(i) = inside[i].transpose();
  return points;
}

// Along a direction, how far a dented ball reaches that nothing mirrors.
double dented(const Vector3& u) {
  return 1 + 0.25 * std::sin(3 * u.y() + 2 * u.z() + 1) + 0.25 * std::cos(2 * u.x() - 3 * u.y()) +
         0.15 * std::sin(4 * u.z() - u.x());
}

Points dented_ball(RandomCloud& random, Index count) {
  Points points = random.sphere(count);
  for (auto x : points.rowwise()) x *= dented(x);
  return points;
}

Points filled_dented_ball(RandomCloud& random, Index count) {
  Points points(count, 3);
  for (Index i = 0; i < count;) {
    const Vector3 x = 1.65 * random.in_box();
    if (x.norm() < dented(x.normalized())) points.row(i++) = x.transpose();
  }
  return points;
}

bool is_volumetric(const Points& points) {
  return is_volumetric(checked_cloud(points, {}, 4, {}), {});
}

double degrees_from(const Result& result, const Vector3& normal) {
  const auto& plane = dynamic_cast<const Plane&>(*result.mirror);
  return std::acos(std::min(1.0, std::abs(plane.normal().dot(normal)))) * 180 / M_PI;
}

TEST(NeighbourhoodMoments, AreTheWeightedMomentsOfTheNearest) {
  RandomCloud random(1);
  const Points points = random.box(300);
  const PointTree tree(points);
  constexpr Index k = 20;
  const std::vector<Index> positions{0, 7, 8, 50, 51, 52, 53, 120, 200, 299};
  visit_neighbourhoods(
      points, tree, k, positions, {}, [&](Index v, const NeighbourhoodMoments& around) {
        const Vector3 x = points.row(tree.order()[positions[v]]);
        std::vector<double> squared;
        for (Index i = 0; i < points.rows(); ++i)
          squared.push_back((points.row(i).transpose() - x).squaredNorm());
        std::nth_element(squared.begin(), squared.begin() + k, squared.end());
        const double radius = std::sqrt(squared[k]);
        EXPECT_NEAR(around.radius, radius, 1e-12);
        Vector3 first = Vector3::Zero();
        Matrix3 second = Matrix3::Zero();
        double sum = 0;
        for (Index i = 0; i < points.rows(); ++i) {
          const Vector3 offset = (points.row(i).transpose() - x) / radius;
          const double weight = std::max(0.0, 1 - offset.squaredNorm());
          sum += weight;
          first += weight * offset;
          second += weight * offset * offset.transpose();
        }
        first /= sum;
        EXPECT_LE((around.mean - first).norm(), 1e-12);
        EXPECT_LE((around.covariance - (second / sum - first * first.transpose())).norm(), 1e-12);
      });
}

TEST(Boundary, BodiesDifferFromSurfacesHoweverNoisy) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    RandomCloud random(seed);
    EXPECT_TRUE(is_volumetric(filled(random, 6000))) << seed;
    EXPECT_TRUE(is_volumetric(filled_dented_ball(random, 6000))) << seed;
    EXPECT_TRUE(is_volumetric(voxels(random.rotation(), 0.06))) << seed;
    for (const double noise : {0.0, 0.01, 0.02, 0.04})
      for (const Index count : {600, 4096, 20000}) {
        Points surface = dented_ball(random, count);
        std::mt19937_64 generator(seed);
        std::normal_distribution<double> normal;
        surface = surface.unaryExpr([&](double x) { return x + noise * 3.5 * normal(generator); });
        EXPECT_FALSE(is_volumetric(surface)) << seed << ", noise " << noise << ", " << count;
      }
  }
}

// Large clouds are not asked point by point: the boundary of a ball is a shell all the same.
TEST(Boundary, LiesAlongTheFaceOfABody) {
  for (const Index count : {5000, 50000, 200000}) {
    RandomCloud random(1);
    Points ball = random.sphere(count);
    for (auto x : ball.rowwise()) x *= std::cbrt(random.uniform(0, 1));
    const Cloud cloud = checked_cloud(ball, {}, 4, {});
    ASSERT_TRUE(is_volumetric(cloud, {})) << count;
    const Points boundary = ball(boundary_of(cloud, {}), Eigen::indexing::all);
    const Eigen::VectorXd depth = 1 - boundary.rowwise().norm().array();
    const double spacing = std::cbrt(4.19 / static_cast<double>(count));
    Index at_face = 0, near_face = 0;
    for (const auto& x : ball.rowwise()) at_face += 1 - x.norm() < 0.4 * spacing;
    for (const double d : depth) near_face += d < 0.4 * spacing;
    EXPECT_GE(static_cast<double>(near_face), 0.9 * static_cast<double>(at_face)) << count;
    EXPECT_LE((depth.array() > 3 * spacing).count(), 0.08 * static_cast<double>(depth.size()))
        << count;
  }
}

TEST(Boundary, DefinesThePlaneOfABody) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    RandomCloud random(seed);
    const Matrix3 turn = random.rotation();
    for (const Points& points :
         {Points(filled(random, 6000) * turn.transpose()), voxels(turn, 0.06)}) {
      const Result result = detect(points, {.method = "plane"});
      EXPECT_EQ(result.statistics.count("boundary_points"), 1u) << seed;
      EXPECT_LE(degrees_from(result, turn.col(0)), 1) << seed;
      EXPECT_GE(result.score, 0.5) << seed;
      EXPECT_EQ(result.pairs.rows(), points.rows()) << "partners are found inside as well";
      EXPECT_EQ(std::get<Index>(result.statistics.at("unpaired_points")), 0);
      EXPECT_NEAR(std::get<double>(result.statistics.at("mean_residual")), result.residuals.mean(),
                  1e-12);
    }
  }
}

TEST(Boundary, NoMirrorIsFoundWhereABodyHasNone) {
  for (std::uint64_t seed = 0; seed < slow_seeds; ++seed) {
    RandomCloud random(seed);
    const Matrix3 turn = random.rotation();
    const Result result =
        detect(Points(filled_dented_ball(random, 6000) * turn), {.method = "auto"});
    EXPECT_EQ(result.verdict(), "none") << seed << ": " << result.reason();
  }
}

TEST(Boundary, DefinesTheCylinderOfABentBody) {
  constexpr double radius = 2;
  for (std::uint64_t seed = 0; seed < slow_seeds; ++seed) {
    RandomCloud random(seed);
    Points points = filled(random, 6000);
    for (auto x : points.rowwise()) {
      const double from_axis = radius + x.x(), angle = x.y() / radius;
      x << from_axis * std::cos(angle) - radius, from_axis * std::sin(angle), x.z();
    }
    const Result result = detect(points, {.method = "cylinder"});
    EXPECT_EQ(result.statistics.count("boundary_points"), 1u) << seed;
    const auto& cylinder = dynamic_cast<const Cylinder&>(*result.mirror);
    EXPECT_NEAR(cylinder.radius(), radius, 0.05 * radius) << seed;
  }
}

TEST(Boundary, SurfacePointsOfABentBodyLieOnItsFreeForm) {
  RandomCloud random(2);
  Points points = filled(random, 6000);
  points.col(0).array() += 0.2 * (points.col(1).array() * 2).sin();
  const Result result = detect(points, {.method = "perpendicular"});
  EXPECT_EQ(result.statistics.count("boundary_points"), 1u);
  EXPECT_GT(result.pairs.rows(), 5000);
  ASSERT_EQ(result.surface_points.rows(), result.pairs.rows());
  const double size = (points.colwise().maxCoeff() - points.colwise().minCoeff()).norm();
  const Points feet = result.mirror->project(result.surface_points);
  Index on_mirror = 0;  // beside its rim the foot of a foot may be another
  for (Index row = 0; row < feet.rows(); ++row)
    on_mirror += (feet.row(row) - result.surface_points.row(row)).norm() <= 1e-6 * size;
  EXPECT_GE(on_mirror, 0.98 * static_cast<double>(feet.rows()));
}

// Exact partners, inside as on the boundary, define a mirror that is of no simple kind.
TEST(Boundary, IsNotExtractedWherePartnersAreExact) {
  RandomCloud random(1);
  const Points positions = random.box(1500);
  Points points(3000, 3);
  const auto height = [](double x, double y) { return 0.15 * (x * x - y * y); };
  for (Index i = 0; i < 1500; ++i) {
    const double x = 2 * positions(i, 0), y = 2 * positions(i, 1);
    const Vector3 foot(x, y, height(x, y)), normal = Vector3(-0.3 * x, 0.3 * y, 1).normalized();
    const double distance = 0.275 + 0.225 * positions(i, 2);
    points.row(2 * i) = (foot + distance * normal).transpose();
    points.row(2 * i + 1) = (foot - distance * normal).transpose();
  }
  ASSERT_TRUE(is_volumetric(points));
  const Result result = detect(points, {.method = "perpendicular"});
  ASSERT_TRUE(result.mirror);
  EXPECT_EQ(result.statistics.count("boundary_points"), 0u);
  std::vector<double> errors;
  for (const auto& row : result.surface_points.rowwise())
    errors.push_back(std::abs(row.z() - height(row.x(), row.y())));
  std::nth_element(errors.begin(), errors.begin() + errors.size() / 2, errors.end());
  EXPECT_LE(errors[errors.size() / 2], 1e-9);
}

}  // namespace
}  // namespace symsurf::boundary_extraction_tests
