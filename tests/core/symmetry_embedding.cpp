#include <gtest/gtest.h>
#include <symsurf/analyses.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <numeric>
#include <set>
#include <string>
#include <vector>

#include "random_cloud.h"
#include "symmetries/embedding/factored_embedding.h"
#include "symmetries/point_group/point_group.h"

namespace symsurf::symmetry_embedding_tests {
namespace {

using Orbits = std::set<std::set<Index>>;

Orbits partition(const std::vector<Index>& names) {
  std::map<Index, std::set<Index>> members;
  for (std::size_t i = 0; i < names.size(); ++i) members[names[i]].insert(static_cast<Index>(i));
  Orbits orbits;
  for (const auto& [name, orbit] : members) orbits.insert(orbit);
  return orbits;
}

Orbits orbits_of(const AnalysisResult& result) {
  const Eigen::MatrixXd& names = result.arrays.at("orbit");
  std::vector<Index> orbits;
  for (Index i = 0; i < names.rows(); ++i) orbits.push_back(static_cast<Index>(names(i)));
  return partition(orbits);
}

// A cloud whose orbits are known, as it was made of them.
struct Sample {
  Points points;
  std::vector<Index> orbits;

  void add_orbit(const Vector3& x, const std::vector<Matrix3>& group) {
    std::vector<Vector3> images;
    for (const Matrix3& element : group) {
      const Vector3 image = element * x;
      const bool is_new = std::none_of(images.begin(), images.end(), [&](const Vector3& other) {
        return (other - image).norm() < 1e-9;
      });
      if (is_new) images.push_back(image);
    }
    const Index name = orbits.empty() ? 0 : orbits.back() + 1, before = points.rows();
    points.conservativeResize(before + static_cast<Index>(images.size()), 3);
    for (std::size_t k = 0; k < images.size(); ++k) {
      points.row(before + static_cast<Index>(k)) = images[k].transpose();
      orbits.push_back(name);
    }
  }
};

Sample cube_sample(RandomCloud& random) {
  Sample sample;
  const auto group = polyhedral_group(4, true, true).elements;
  sample.add_orbit({1, 1, 1}, group);
  sample.add_orbit({1, 0, 0}, group);
  for (int k = 0; k < 8; ++k)
    sample.add_orbit({1, random.uniform(-1, 1), random.uniform(-1, 1)}, group);
  return sample;
}

// A regular prism on five sides, two high.
Sample prism_sample(RandomCloud& random) {
  Sample sample;
  const auto group = axial_group(5, {.across = true, .vertical = true}).elements;
  const double apothem = std::cos(std::numbers::pi / 5), half = std::sin(std::numbers::pi / 5);
  for (int k = 0; k < 12; ++k) {
    const double along = random.uniform(-half, half);
    sample.add_orbit({along, apothem, random.uniform(-1, 1)}, group);
    const double inside = random.uniform(0, 0.8);
    sample.add_orbit({inside * along, inside * apothem, 1}, group);
  }
  return sample;
}

// Seat, back and four legs, the hind ones shorter: one mirror.
Sample chair_sample(RandomCloud& random) {
  Sample sample;
  const std::vector<Matrix3> group = {Matrix3::Identity(), reflection(Vector3::UnitX())};
  const auto box = [&](const Vector3& low, const Vector3& high) {
    for (int k = 0; k < 60; ++k) {
      Vector3 x;
      for (int axis = 0; axis < 3; ++axis) x[axis] = random.uniform(low[axis], high[axis]);
      const Index face = random.below(3);
      x[face] = random.below(2) == 0 ? low[face] : high[face];
      sample.add_orbit(x, group);
    }
  };
  box({0, 0, 0}, {0.5, 1, 0.1});
  box({0, 0.9, 0.1}, {0.5, 1, 1.2});
  box({0.4, 0, -1}, {0.5, 0.1, 0});
  box({0.4, 0.9, -0.9}, {0.5, 1, 0});
  return sample;
}

struct Shape {
  std::string name, stationary;
  Index symmetries;
  std::function<Sample(RandomCloud&)> make;
};

const std::vector<Shape> shapes{{"cube", "point", 48, cube_sample},
                                {"prism", "point", 20, prism_sample},
                                {"chair", "plane", 2, chair_sample}};

// The points in another order, pose and unit; `order` gets where each came from.
Points moved(const Points& points, RandomCloud& random, std::vector<Index>& order) {
  order.resize(points.rows());
  std::iota(order.begin(), order.end(), Index{0});
  for (Index i = points.rows() - 1; i > 0; --i) std::swap(order[i], order[random.below(i + 1)]);
  const Matrix3 rotation = random.rotation();
  const Vector3 shift = 1e3 * random.in_box();
  const double scale = std::exp(random.uniform(-7, 7));
  Points other = scale * points(order, Eigen::indexing::all) * rotation.transpose();
  other.rowwise() += scale * shift.transpose();
  return other;
}

// With all coordinates, of which the array has the first.
FactoredEmbedding embedding_of(const Points& points, const EmbeddingOptions& options = {}) {
  const PointTree tree(points);
  constexpr double tolerance = 0.03;
  return factored_embedding(points, tree, near_symmetries(points, tree, tolerance, Context()),
                            options, Context());
}

double distance(const FactoredEmbedding& embedding, Index one, Index other) {
  return (embedding.coordinates.row(one) - embedding.coordinates.row(other)).norm();
}

TEST(SymmetryEmbedding, FindsTheOrbitsThatSamplesAreMadeOf) {
  for (const Shape& shape : shapes)
    for (std::uint64_t seed = 0; seed < seeds; ++seed) {
      RandomCloud random(seed);
      const Sample sample = shape.make(random);
      const AnalysisResult result = analyse("symmetry_embedding", sample.points);
      EXPECT_EQ(orbits_of(result), partition(sample.orbits)) << shape.name << seed;
      EXPECT_EQ(std::get<Index>(result.statistics.at("symmetries")), shape.symmetries);
      EXPECT_EQ(std::get<std::string>(result.statistics.at("stationary_set")), shape.stationary);
    }
}

TEST(SymmetryEmbedding, FactorsSymmetryOut) {
  for (const Shape& shape : shapes) {
    RandomCloud random(7);
    const Sample sample = shape.make(random);
    const FactoredEmbedding embedding = embedding_of(sample.points);
    double within = 0, between = INFINITY;
    for (Index i = 0; i < sample.points.rows(); ++i)
      for (Index j = 0; j < i; ++j) {
        const double d = distance(embedding, i, j);
        if (sample.orbits[i] == sample.orbits[j])
          within = std::max(within, d);
        else
          between = std::min(between, d);
      }
    EXPECT_GT(between, 0) << shape.name;
    EXPECT_LE(within, 1e-6 * between) << shape.name;
  }
}

TEST(SymmetryEmbedding, DoesNotDependOnPoseUnitAndOrder) {
  for (const Shape& shape : shapes)
    for (std::uint64_t seed = 0; seed < seeds; ++seed) {
      RandomCloud random(seed);
      const Sample sample = shape.make(random);
      std::vector<Index> order, names;
      const Points other = moved(sample.points, random, order);
      for (const Index i : order) names.push_back(sample.orbits[i]);
      const FactoredEmbedding one = embedding_of(sample.points), two = embedding_of(other);
      EXPECT_EQ(partition(two.orbits), partition(names)) << shape.name << seed;
      for (Index i = 1; i < other.rows(); ++i)
        EXPECT_NEAR(distance(two, 0, i), distance(one, order[0], order[i]), 1e-6)
            << shape.name << seed;
    }
}

// Lipman et al.: where points correspond within orbits alone, the eigenvalues of the matrix are the
// orbits' sizes, and an eigenvector of length 1 is constant on each.
TEST(SymmetryEmbedding, HasTheOrbitsSizesForEigenvalues) {
  RandomCloud random(0);
  const Sample sample = cube_sample(random);
  const FactoredEmbedding embedding = embedding_of(sample.points, {.localization = 1e-4});
  std::vector<Index> sizes = embedding.sizes;
  std::sort(sizes.rbegin(), sizes.rend());
  ASSERT_EQ(embedding.eigenvalues.size(), static_cast<Index>(sizes.size()));
  for (std::size_t k = 0; k < sizes.size(); ++k)
    EXPECT_NEAR(embedding.eigenvalues[static_cast<Index>(k)], static_cast<double>(sizes[k]), 1e-9);
  for (Index i = 0; i < sample.points.rows(); ++i) {
    const auto size = static_cast<double>(embedding.sizes[embedding.orbits[i]]);
    EXPECT_NEAR(embedding.coordinates.row(i).norm(), std::sqrt(size), 1e-9);
  }
}

// A row of Lipman's matrix, by all maps and points.
Eigen::VectorXd correspondences(const Points& points, Index i, const NearSymmetries& symmetries,
                                double localization) {
  Eigen::VectorXd least = Eigen::VectorXd::Constant(points.rows(), INFINITY);
  const Vector3 x = points.row(i).transpose();
  for (const auto& [map, deviation] : symmetries.maps)
    for (const Vector3& image : {map * x, map.inverse() * x})
      least = least.cwiseMin(
          ((points.rowwise() - image.transpose()).rowwise().norm().array() / symmetries.diameter +
           deviation)
              .matrix());
  return (-(least / localization).array().square()).exp();
}

// Lipman et al.: the matrix's first eigenvectors, times their eigenvalues.
TEST(SymmetryEmbedding, HasTheDistancesOfTheWholeMatrix) {
  constexpr Index half = 1000, coordinates = 16;
  constexpr double localization = 0.05;
  for (const double noise : {0.0, 0.01}) {
    RandomCloud random(3);
    Points points(2 * half, 3);
    for (Index i = 0; i < half; ++i) {
      const Vector3 x = Vector3(1, 0.8, 0.5).cwiseProduct(random.in_box().normalized());
      points.row(2 * i) = x.transpose() + noise * random.in_box().transpose();
      points.row(2 * i + 1) << -x.x(), x.y(), x.z();
    }
    const PointTree tree(points);
    const NearSymmetries symmetries = near_symmetries(points, tree, 0.03, Context());
    EXPECT_EQ(symmetries.exact, noise == 0);
    const FactoredEmbedding embedding = factored_embedding(
        points, tree, symmetries,
        {.localization = localization, .power = 1, .coordinates = coordinates}, Context());
    Eigen::MatrixXd whole(2 * half, 2 * half);
    for (Index i = 0; i < whole.cols(); ++i)
      whole.col(i) = correspondences(points, i, symmetries, localization);
    // The matrix's product with each coordinate is that coordinate times its eigenvalue.
    const Eigen::MatrixXd& given = embedding.coordinates;
    const Eigen::MatrixXd off = whole * given - given * embedding.eigenvalues.asDiagonal();
    for (Index k = 0; k < coordinates; ++k) {
      EXPECT_LT(off.col(k).norm(), 0.01 * embedding.eigenvalues[k] * given.col(k).norm()) << k;
      EXPECT_NEAR(given.col(k).norm(), embedding.eigenvalues[k], 0.01 * embedding.eigenvalues[k]);
    }
    // The greatest ones: what is left when they are taken away has lesser ones alone.
    Eigen::VectorXd rest = Eigen::VectorXd::LinSpaced(2 * half, -1, 1);
    double greatest = 0;
    for (int step = 0; step < 100; ++step) {
      for (Index k = 0; k < coordinates; ++k)
        rest -= given.col(k) * (given.col(k).dot(rest) / given.col(k).squaredNorm());
      rest = whole * rest;
      greatest = rest.norm();
      rest /= greatest;
    }
    EXPECT_LT(greatest, 1.01 * embedding.eigenvalues[coordinates - 1]);
  }
}

TEST(SymmetryEmbedding, TellsWhatStaysInPlace) {
  RandomCloud random(0);
  Sample turned, chiral;
  for (int k = 0; k < 20; ++k) {
    turned.add_orbit(random.in_box() + Vector3(1, 0, 0), axial_group(3, {}).elements);
    chiral.add_orbit(random.in_box(), {Matrix3::Identity()});
  }
  const Matrix3 rotation = random.rotation();
  const Vector3 shift(1, 2, 3);
  const auto placed = [&](const Sample& sample) {
    Points points = sample.points * rotation.transpose();
    points.rowwise() += shift.transpose();
    return points;
  };
  const AnalysisResult line = analyse("symmetry_embedding", placed(turned));
  EXPECT_EQ(std::get<std::string>(line.statistics.at("stationary_set")), "line");
  ASSERT_EQ(line.axes.size(), 1u);
  EXPECT_EQ(line.axes[0].order, 3);
  EXPECT_NEAR(std::abs(line.axes[0].direction.dot(rotation.col(2))), 1, 1e-9);
  EXPECT_LT((line.axes[0].point - shift).cross(rotation.col(2)).norm(), 1e-6);

  const AnalysisResult none = analyse("symmetry_embedding", placed(chiral));
  EXPECT_EQ(std::get<std::string>(none.statistics.at("stationary_set")), "none");
  EXPECT_EQ(orbits_of(none).size(), 20u);
  EXPECT_LT(none.arrays.at("stationary_distance").maxCoeff(), 1e-12);

  const AnalysisResult plane = analyse("symmetry_embedding", placed(chair_sample(random)));
  ASSERT_EQ(plane.planes.size(), 1u);
  EXPECT_NEAR(std::abs(plane.planes[0].normal().dot(rotation.col(0))), 1, 1e-9);
  EXPECT_NEAR(plane.planes[0].signed_distance(shift), 0, 1e-6);
}

TEST(SymmetryEmbedding, FollowsSymmetriesThatAreNotExact) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    RandomCloud random(seed);
    Sample sample = chair_sample(random);
    for (Index i = 0; i < sample.points.rows(); ++i)
      sample.points.row(i) += 0.004 * random.in_box().transpose();
    const AnalysisResult result = analyse("symmetry_embedding", sample.points);
    EXPECT_FALSE(std::get<bool>(result.statistics.at("exact")));
    EXPECT_EQ(std::get<Index>(result.statistics.at("symmetries")), 2);
    EXPECT_EQ(std::get<std::string>(result.statistics.at("stationary_set")), "plane");
    const FactoredEmbedding embedding = embedding_of(sample.points);
    double within = 0, between = 0;
    for (Index i = 0; i + 1 < sample.points.rows(); ++i) {
      if (sample.orbits[i] != sample.orbits[i + 1]) continue;
      within += distance(embedding, i, i + 1);
      between += distance(embedding, i, (i + 41) % sample.points.rows());
    }
    EXPECT_LT(within, 0.1 * between);
  }
}

TEST(SymmetryEmbedding, IsFiniteForAnyPower) {
  AnalysisOptions options;
  options.parameters["power"] = 30.0;
  const AnalysisResult found = analyse("symmetry_embedding", RandomCloud(0).box(1500), options);
  EXPECT_TRUE(found.arrays.at("embedding").allFinite());
  options.parameters["power"] = 100.0;  // of 1500, which is infinite
  EXPECT_THROW(analyse("symmetry_embedding", RandomCloud(0).box(1500), options), InvalidParameter);
}

}  // namespace
}  // namespace symsurf::symmetry_embedding_tests
