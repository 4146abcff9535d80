#include <gtest/gtest.h>
#include <symsurf/context.h>
#include <symsurf/points.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <vector>

#include "expect_error.h"
#include "random_cloud.h"

namespace symsurf::normals_tests {
namespace {

// The k nearest by (distance, index), from a scan.
Points neighbourhood(const Points& points, Index i, Index k) {
  std::vector<std::pair<double, Index>> all;
  for (Index j = 0; j < points.rows(); ++j)
    all.emplace_back((points.row(j) - points.row(i)).squaredNorm(), j);
  std::sort(all.begin(), all.end());
  Points patch(k, 3);
  for (Index n = 0; n < k; ++n) patch.row(n) = points.row(all[n].second);
  return patch;
}

Points bumpy(RandomCloud& random, Index n) {
  Points points = random.box(n);
  points.col(2) = 0.2 * (3 * points.col(0).array()).sin() * (2 * points.col(1).array()).cos();
  return points;
}

TEST(Normals, PcaIsTheDirectionOfLeastVariance) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    RandomCloud random(seed);
    for (const Points& points : {bumpy(random, 400), random.box(400)})
      for (const Index k : {3, 10, 25}) {
        const Points normals = estimate_normals(points, k);
        for (Index i = 0; i < points.rows(); ++i) {
          Points patch = neighbourhood(points, i, k);
          patch.rowwise() -= patch.colwise().mean().eval();
          const double least = Eigen::JacobiSVD<Eigen::MatrixXd>(patch).singularValues()[2];
          const Vector3 normal = normals.row(i);
          EXPECT_NEAR(normal.norm(), 1, 1e-14);
          EXPECT_NEAR((patch * normal).norm(), least, 1e-8 * patch.norm());
          EXPECT_EQ(normal.maxCoeff(), normal.cwiseAbs().maxCoeff());
        }
      }
  }
}

TEST(Normals, RegressionIsTheLeastSquaresPlane) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    RandomCloud random(seed);
    for (const Points& points : {bumpy(random, 400), random.lattice(200, 4)}) {
      const Points normals = estimate_normals(points, 10, "regression");
      for (Index i = 0; i < points.rows(); ++i) {
        Points patch = neighbourhood(points, i, 10);
        patch.rowwise() -= patch.colwise().mean().eval();
        Eigen::JacobiSVD<Eigen::MatrixXd> svd(patch.leftCols<2>(),
                                              Eigen::ComputeThinU | Eigen::ComputeThinV);
        svd.setThreshold(1e-8);
        const Eigen::Vector2d slope = svd.solve(patch.col(2));
        const Vector3 expected = Vector3(-slope.x(), -slope.y(), 1).normalized();
        EXPECT_LE((normals.row(i).transpose() - expected).norm(), 1e-9);
      }
    }
  }
}

TEST(Normals, OfAPlaneAreThePlanes) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    RandomCloud random(seed);
    const Matrix3 pose = random.rotation();
    Points points = random.box(300);
    points.col(2).setZero();
    points = points * pose.transpose();
    const Vector3 truth = pose.col(2);
    for (const char* method : {"pca", "regression"}) {
      const Points normals = estimate_normals(points, 10, method);
      EXPECT_GE((normals * truth).cwiseAbs().minCoeff(), 1 - 1e-12) << method;
    }
  }
}

TEST(Normals, OfALineAreAcrossIt) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    RandomCloud random(seed);
    const Vector3 along = random.direction();
    for (const Vector3& axis : {along, Vector3(Vector3::Unit(seed % 3))}) {
      const Points points = random.box(100).col(0) * axis.transpose();
      const Points normals = estimate_normals(points);
      EXPECT_LE((normals * axis).cwiseAbs().maxCoeff(), 1e-12);
      EXPECT_LE((normals.rowwise().norm().array() - 1).abs().maxCoeff(), 1e-15);
    }
  }
}

TEST(Normals, OfASphereAreItsRadii) {
  const Points points = RandomCloud(3).sphere(5000);
  const Points normals = estimate_normals(points);
  const Eigen::VectorXd cosines = normals.cwiseProduct(points).rowwise().sum().cwiseAbs();
  EXPECT_GE(cosines.minCoeff(), std::cos(0.1));
}

TEST(Normals, OfAVerticalPlaneHaveTheLeastSlopeByRegression) {
  RandomCloud random(4);
  Points points = random.box(100);
  points.col(0).setConstant(0.1);
  const Points normals = estimate_normals(points, 10, "regression");
  EXPECT_EQ(normals.col(0).cwiseAbs().maxCoeff(), 0);
  EXPECT_GT(normals.col(2).minCoeff(), 0);
}

TEST(Normals, TurnWithTheCloudAndKnowNoUnit) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    RandomCloud random(seed);
    const Points points = bumpy(random, 500), normals = estimate_normals(points);
    const Matrix3 rotation = random.rotation();
    const Points turned = estimate_normals(Points(points * rotation.transpose()));
    const Points expected = normals * rotation.transpose();
    EXPECT_GE(turned.cwiseProduct(expected).rowwise().sum().cwiseAbs().minCoeff(), 1 - 1e-9);
    for (const double unit : {0x1p-300, 0x1p300})
      EXPECT_EQ(estimate_normals(Points(points * unit)), normals);
    const Points far = (points.array() + 1e6).matrix();
    EXPECT_GE(estimate_normals(far).cwiseProduct(normals).rowwise().sum().minCoeff(), 1 - 1e-9);
  }
}

TEST(Normals, AreTheSameBitsForAnyNumberOfThreads) {
  const Points points = RandomCloud(5).sphere(10000);
  const Points normals = estimate_normals(points, 10, "pca", Context({}, 1));
  for (const int threads : {2, 3, 8})
    EXPECT_EQ(estimate_normals(points, 10, "pca", Context({}, threads)), normals);
}

TEST(Normals, OfEqualPointsAreUnitVectors) {
  const Points points = Points::Constant(20, 3, 7);
  for (const char* method : {"pca", "regression"})
    EXPECT_EQ(estimate_normals(points, 10, method).rowwise().norm(), Eigen::VectorXd::Ones(20));
}

TEST(Normals, SayWhatIsWrong) {
  const Points points = RandomCloud(0).box(20);
  expect_error<InvalidParameter>("neighbours is 2; allowed is 3 and above",
                                 [&] { estimate_normals(points, 2); });
  expect_error<InvalidParameter>("method is guess; allowed is pca | regression",
                                 [&] { estimate_normals(points, 10, "guess"); });
  expect_error<InvalidInput>("20 points given; at least 21", [&] { estimate_normals(points, 21); });
  Points broken = points;
  broken(3, 2) = std::nan("");
  expect_error<InvalidInput>("point 3", [&] { estimate_normals(broken); });
}

}  // namespace
}  // namespace symsurf::normals_tests
