#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "base/math.h"
#include "random_cloud.h"
#include "symmetries/recurring/recurring_parts.h"

namespace symsurf::feature_lines_tests {
namespace {

constexpr double angle = std::numbers::pi / 6;

// A prism over a regular polygon in a random pose, each of its sides divided in `cells`.
FeatureLines lines_of_prism(int sides, int cells, RandomCloud& random) {
  const Matrix3 turn = random.rotation();
  std::vector<Vector3> points;
  std::vector<Index> corners;
  const auto add = [&](double turns, double share, double height) {
    const auto at = [&](double k) {
      const double around = 2 * std::numbers::pi * k / sides;
      return Vector3(std::cos(around), std::sin(around), height);
    };
    points.push_back(turn * ((1 - share) * at(turns) + share * at(turns + 1)));
  };
  for (const double height : {0.0, 1.0})
    for (int k = 0; k < sides; ++k)
      for (int c = 0; c < cells; ++c) add(k, static_cast<double>(c) / cells, height);
  const Index around = sides * cells;
  points.push_back(Vector3::Zero());
  points.push_back(turn * Vector3::UnitZ());
  for (Index k = 0; k < around; ++k) {
    const Index next = (k + 1) % around;
    corners.insert(corners.end(), {k, next, around + next, k, around + next, around + k});
    corners.insert(corners.end(), {k, next, 2 * around, around + k, around + next, 2 * around + 1});
  }
  Points rows(static_cast<Index>(points.size()), 3);
  for (Index i = 0; i < rows.rows(); ++i) rows.row(i) = points[i].transpose();
  const TrianglesView faces(corners.data(), static_cast<Index>(corners.size()) / 3);
  return feature_lines(rows, faces, angle, {});
}

TEST(FeatureLines, AreTheEdgesOfAPrismHoweverTheyAreDivided) {
  RandomCloud random(0);
  for (const int cells : {1, 2, 5}) {
    const FeatureLines found = lines_of_prism(6, cells, random);
    EXPECT_EQ(found.corners.size(), 12u);
    ASSERT_EQ(found.lines.size(), 18u);
    for (const FeatureLine& line : found.lines) {
      EXPECT_NEAR(line.length, 1, 1e-12);  // as long as the polygon's radius, and its height
      ASSERT_TRUE(line.has_ends());
      const Vector3 middle = (found.corners[line.start] + found.corners[line.end]) / 2;
      EXPECT_LT((line.middle() - middle).norm(), 1e-12);
      ASSERT_EQ(line.wings.size(), 2u);
      // At right angles, or at the hexagon's.
      const double cosine = line.wings[0].dot(line.wings[1]);
      EXPECT_LT(std::min(std::abs(cosine), std::abs(cosine + 0.5)), 1e-9);
    }
    for (const std::vector<Index>& at : found.at) EXPECT_EQ(at.size(), 3u);
  }
}

TEST(FeatureLines, OfARoundBarAreItsRims) {
  RandomCloud random(1);
  const FeatureLines found = lines_of_prism(40, 1, random);
  EXPECT_TRUE(found.corners.empty());
  ASSERT_EQ(found.lines.size(), 2u);
  for (const FeatureLine& line : found.lines) {
    EXPECT_FALSE(line.has_ends());
    EXPECT_NEAR(line.length, 80 * std::sin(std::numbers::pi / 40), 1e-12);
  }
}

// Random points of a convex polyhedron's facets, each given by its corners in order, and its lines.
FeatureLines lines_of_cloud(const std::vector<std::vector<Vector3>>& facets, RandomCloud& random) {
  std::vector<Vector3> points;
  for (const std::vector<Vector3>& facet : facets)
    for (std::size_t k = 1; k + 1 < facet.size(); ++k) {
      const Vector3 a = facet[k] - facet[0], b = facet[k + 1] - facet[0];
      const auto count = static_cast<int>(1000 * a.cross(b).norm());
      for (int point = 0; point < count; ++point) {
        const double u = std::sqrt(random.uniform(0, 1)), v = random.uniform(0, 1);
        points.push_back(facet[0] + u * ((1 - v) * a + v * b));
      }
    }
  const CloudFacets cloud(rows_of(points), Context());
  EXPECT_EQ(cloud.planes.size(), facets.size());
  return feature_lines(cloud, angle, Context());
}

// That the graph has these corners, with so many lines at each.
void expect_corners(const FeatureLines& graph, const std::vector<Vector3>& corners,
                    const std::vector<std::size_t>& lines_at) {
  EXPECT_EQ(graph.corners.size(), corners.size());
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const auto found =
        std::find_if(graph.corners.begin(), graph.corners.end(),
                     [&](const Vector3& x) { return (x - corners[k]).norm() < 1e-3; });
    ASSERT_NE(found, graph.corners.end()) << corners[k].transpose();
    EXPECT_EQ(graph.at[found - graph.corners.begin()].size(), lines_at[k]);
  }
}

TEST(FeatureLines, OfACloudAreTheEdgesOfABox) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    SCOPED_TRACE(seed);
    RandomCloud random(seed);
    const Matrix3 turn = random.rotation();
    std::vector<Vector3> x;
    for (const double height : {0.0, 1.0})
      for (const Vector3& corner : {Vector3(0, 0, height), Vector3(3, 0, height),
                                    Vector3(3, 2, height), Vector3(0, 2, height)})
        x.push_back(turn * corner);
    const FeatureLines graph = lines_of_cloud({{x[0], x[1], x[2], x[3]},
                                               {x[4], x[5], x[6], x[7]},
                                               {x[0], x[1], x[5], x[4]},
                                               {x[1], x[2], x[6], x[5]},
                                               {x[2], x[3], x[7], x[6]},
                                               {x[3], x[0], x[4], x[7]}},
                                              random);
    EXPECT_EQ(graph.lines.size(), 12u);
    expect_corners(graph, x, std::vector<std::size_t>(8, 3));
    double length = 0;
    for (const FeatureLine& line : graph.lines) length += line.length;
    EXPECT_NEAR(length, 24, 1e-2);
  }
}

TEST(FeatureLines, OfACloudMeetWhereFourFacetsDo) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    SCOPED_TRACE(seed);
    RandomCloud random(seed);
    const std::vector<Vector3> x{{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}, {0, 0, 1.5}};
    const FeatureLines graph = lines_of_cloud({{x[0], x[1], x[2], x[3]},
                                               {x[0], x[1], x[4]},
                                               {x[1], x[2], x[4]},
                                               {x[2], x[3], x[4]},
                                               {x[3], x[0], x[4]}},
                                              random);
    EXPECT_EQ(graph.lines.size(), 8u);
    expect_corners(graph, x, {3, 3, 3, 3, 4});
  }
}

}  // namespace
}  // namespace symsurf::feature_lines_tests
