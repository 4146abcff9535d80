#include "cloud/laplacian.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <vector>

#include "base/linear_algebra.h"
#include "random_cloud.h"

namespace symsurf::laplacian_tests {
namespace {

// A square of unit edges, each of its squares cut along a diagonal.
struct Sheet {
  Points points;
  Triangles faces;

  explicit Sheet(Index side) : points((side + 1) * (side + 1), 3), faces(2 * side * side, 3) {
    const auto at = [&](Index x, Index y) { return x * (side + 1) + y; };
    Index face = 0;
    for (Index x = 0; x <= side; ++x)
      for (Index y = 0; y <= side; ++y) {
        points.row(at(x, y)) << static_cast<double>(x), static_cast<double>(y), 0;
        if (x == side || y == side) continue;
        faces.row(face++) << at(x, y), at(x + 1, y), at(x + 1, y + 1);
        faces.row(face++) << at(x, y), at(x + 1, y + 1), at(x, y + 1);
      }
  }
};

Points spiral_sphere(Index count) {
  Points points(count, 3);
  for (Index i = 0; i < count; ++i) {
    const double z = 1 - (2.0 * static_cast<double>(i) + 1) / static_cast<double>(count);
    const double turn = 2 * std::numbers::pi * std::numbers::phi * static_cast<double>(i);
    const double radius = std::sqrt(1 - z * z);
    points.row(i) << radius * std::cos(turn), radius * std::sin(turn), z;
  }
  return points;
}

TEST(SparseEigen, GivesTheEigenpairsOfACycle) {
  constexpr Index size = 400, count = 9;
  std::vector<Eigen::Triplet<double>> entries;
  for (Index i = 0; i < size; ++i) {
    entries.emplace_back(i, i, 2.0);
    entries.emplace_back(i, (i + 1) % size, -1.0);
    entries.emplace_back((i + 1) % size, i, -1.0);
  }
  Eigen::SparseMatrix<double> cycle(size, size);
  cycle.setFromTriplets(entries.begin(), entries.end());
  const auto found = least_eigenpairs(cycle, Eigen::VectorXd::Ones(size), count, -1e-3, Context());
  ASSERT_EQ(found.values.size(), count);
  for (Index k = 0; k < count; ++k) {
    const auto wave = static_cast<double>((k + 1) / 2);
    EXPECT_NEAR(found.values[k], 2 - 2 * std::cos(2 * std::numbers::pi * wave / size), 1e-9);
  }
}

TEST(SparseEigen, AgreesWithADenseDecomposition) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    RandomCloud random(seed);
    const Sheet sheet(16);
    Points points = sheet.points;
    for (Index i = 0; i < points.rows(); ++i) points.row(i) += 0.3 * random.in_box().transpose();
    const auto [stiffness, areas] = cotangent_laplacian(points, sheet.faces);
    const auto all = eigen_of(Eigen::MatrixXd(stiffness), Eigen::MatrixXd(areas.asDiagonal()));
    const auto least = least_eigenpairs(stiffness, areas, 12, -1e-2, Context());
    ASSERT_EQ(least.values.size(), 12);
    EXPECT_LT((least.values - all.values.head(12)).norm(), 1e-7);
    const Eigen::MatrixXd products =
        least.vectors.transpose() * areas.asDiagonal() * all.vectors.leftCols(12);
    EXPECT_LT((products.cwiseAbs() - Eigen::MatrixXd::Identity(12, 12)).norm(), 1e-4);
  }
}

// Linear elements are exact for linear functions.
TEST(CotangentLaplacian, GivesTheEnergyOfLinearFunctions) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    RandomCloud random(seed);
    const Sheet sheet(8);
    const Matrix3 rotation = random.rotation();
    const Points turned = sheet.points * rotation.transpose();
    const auto [stiffness, areas] = cotangent_laplacian(turned, sheet.faces);
    EXPECT_NEAR(areas.sum(), 64, 1e-9);
    const double a = random.uniform(-2, 2), b = random.uniform(-2, 2);
    const Eigen::VectorXd linear = a * sheet.points.col(0) + b * sheet.points.col(1);
    EXPECT_NEAR(linear.dot(stiffness * linear), (a * a + b * b) * 64, 1e-8);
  }
}

TEST(CotangentLaplacian, IsFiniteForDegenerateFaces) {
  Points points(5, 3);
  points << 0, 0, 0, 1, 0, 0, 0, 1, 0, 0.5, 0, 0, 7, 7, 7;
  Triangles faces(3, 3);
  faces << 0, 1, 2, 0, 3, 1, 2, 2, 1;  // a needle without area, an edge
  const auto [stiffness, areas] = cotangent_laplacian(points, faces);
  EXPECT_TRUE(Eigen::MatrixXd(stiffness).allFinite());
  EXPECT_LT((stiffness * Eigen::VectorXd::Ones(5)).norm(), 1e-6 * stiffness.norm());
  EXPECT_GT(areas[3], 0);
  EXPECT_EQ(areas[4], 0);
}

// Those of the unit sphere are l (l + 1), each 2 l + 1 times.
TEST(CloudLaplacian, HasTheEigenvaluesOfASphere) {
  const Points points = spiral_sphere(2000);
  const CloudLaplacian laplacian = cloud_laplacian(points, Context());
  EXPECT_NEAR(laplacian.areas.sum(), 4 * std::numbers::pi, 0.2);
  const auto found = least_eigenpairs(laplacian.stiffness, laplacian.areas, 16, -1e-2, Context());
  ASSERT_EQ(found.values.size(), 16);
  EXPECT_NEAR(found.values[0], 0, 1e-6);
  for (Index k = 1; k < 16; ++k) {
    const double l = std::floor(std::sqrt(static_cast<double>(k)));
    EXPECT_NEAR(found.values[k], l * (l + 1), 0.05 * l * (l + 1)) << k;
  }
}

TEST(CloudLaplacian, WindsItsTrianglesAlike) {
  const Points points = spiral_sphere(1000);
  const Triangles triangles = cloud_laplacian(points, Context()).triangles;
  EXPECT_GT(triangles.rows(), 5 * points.rows());
  Index outward = 0;
  for (Index t = 0; t < triangles.rows(); ++t) {
    const Vector3 a = points.row(triangles(t, 0)), b = points.row(triangles(t, 1)),
                  c = points.row(triangles(t, 2));
    outward += (b - a).cross(c - a).dot(a) > 0;
  }
  EXPECT_TRUE(outward == 0 || outward == triangles.rows()) << outward;
}

}  // namespace
}  // namespace symsurf::laplacian_tests
