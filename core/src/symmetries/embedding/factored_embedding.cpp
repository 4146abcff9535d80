#include "symmetries/embedding/factored_embedding.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "base/eigenvectors.h"
#include "base/math.h"
#include "base/parallel.h"

namespace symsurf {

namespace {

constexpr Index most_leaders = 300;        // whose matrix is decomposed
constexpr double least_eigenvalue = 1e-9;  // of the largest: others are rounding
constexpr double partner_reach = 2e-6;     // diameters: twice the rounding of exact maps

// The points that chains of exact partners join, numbered by their first ones.
std::vector<Index> exact_orbits(PointsView points, const PointTree& tree,
                                const NearSymmetries& symmetries) {
  std::vector<Index> root(points.size());
  std::iota(root.begin(), root.end(), Index{0});
  const auto root_of = [&](Index i) {
    while (root[i] != i) i = root[i] = root[root[i]];
    return i;
  };
  const double reach = partner_reach * symmetries.diameter;
  for (const NearSymmetry& symmetry : symmetries.maps)
    for (Index i = 0; i < points.size(); ++i) {
      const Index j = tree.nearest(symmetry.map * points[i], reach * reach).index;
      if (j < 0) continue;
      const Index one = root_of(i), other = root_of(j);
      root[std::max(one, other)] = std::min(one, other);
    }
  std::vector<Index> number(points.size(), -1), orbits;
  Index count = 0;
  for (Index i = 0; i < points.size(); ++i) {
    Index& name = number[root_of(i)];
    if (name < 0) name = count++;
    orbits.push_back(name);
  }
  return orbits;
}

// One point of each orbit of exact partners, or all points.
struct Nodes {
  std::vector<Index> of_point;
  std::vector<Index> point;  // the first of each
  Eigen::VectorXd mass;      // points

  explicit Nodes(std::vector<Index> numbers) : of_point(std::move(numbers)) {
    std::vector<double> counts;
    for (std::size_t i = 0; i < of_point.size(); ++i) {
      if (of_point[i] == static_cast<Index>(point.size())) {
        point.push_back(static_cast<Index>(i));
        counts.push_back(0);
      }
      ++counts[of_point[i]];
    }
    mass = Eigen::Map<const Eigen::VectorXd>(counts.data(), static_cast<Index>(counts.size()));
  }
  Index size() const { return static_cast<Index>(point.size()); }
};

// S of all nodes and one, in diameters.
Eigen::VectorXd dissimilarities(PointsView points, const Nodes& nodes, Index to,
                                const NearSymmetries& symmetries, const Context& context) {
  std::vector<std::pair<double, Vector3>> images;
  const Vector3 x = points[nodes.point[to]];
  for (const NearSymmetry& symmetry : symmetries.maps) {
    images.emplace_back(symmetry.deviation, symmetry.map * x);
    // The same deviation the other way; of exact maps the inverses are among them.
    if (!symmetries.exact) images.emplace_back(symmetry.deviation, symmetry.map.inverse() * x);
  }
  std::stable_sort(images.begin(), images.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  Eigen::VectorXd least(nodes.size());
  parallel_for(context, nodes.size(), 4096, [&](Index begin, Index end) {
    for (Index a = begin; a < end; ++a) {
      const Vector3 y = points[nodes.point[a]];
      least[a] = infinity;
      for (const auto& [deviation, image] : images) {
        // Roots are taken of what is less only: few of the many pairs are.
        const double reach = (least[a] - deviation) * symmetries.diameter,
                     squared = (image - y).squaredNorm();
        if (reach <= 0) break;
        if (squared < reach * reach)
          least[a] = deviation + std::sqrt(squared) / symmetries.diameter;
      }
    }
  });
  return least;
}

// Nodes each of which lies farthest, by S, from those before; the first from the centre.
struct Leaders {
  std::vector<Index> nodes;
  Eigen::MatrixXd dissimilarity;  // a row a node, a column a leader
  std::vector<Index> nearest;     // of each node, by its number among the leaders

  Leaders(PointsView points, const Nodes& all, const NearSymmetries& symmetries, double resolution,
          const Context& context) {
    Eigen::VectorXd least(all.size());
    for (Index a = 0; a < all.size(); ++a)
      least[a] = (points[all.point[a]] - symmetries.centre).norm();
    nearest.assign(all.size(), 0);
    const Index most = std::min(most_leaders, all.size());
    dissimilarity.resize(all.size(), most);
    while (static_cast<Index>(nodes.size()) < most) {
      context.report(static_cast<double>(nodes.size()) / static_cast<double>(most));
      Index farthest;
      const double away = least.maxCoeff(&farthest);
      if (!nodes.empty() && away <= resolution) break;
      const auto leader = static_cast<Index>(nodes.size());
      dissimilarity.col(leader) =
          dissimilarities(points, all, farthest, symmetries, Context({}, 1));
      for (Index a = 0; a < all.size(); ++a)
        if (nodes.empty() || dissimilarity(a, leader) < least[a]) {
          least[a] = dissimilarity(a, leader);
          nearest[a] = leader;
        }
      nodes.push_back(farthest);
    }
    dissimilarity.conservativeResize(Eigen::NoChange, static_cast<Index>(nodes.size()));
  }
};

}  // namespace

FactoredEmbedding factored_embedding(PointsView points, const PointTree& tree,
                                     const NearSymmetries& symmetries,
                                     const EmbeddingOptions& options, const Context& context) {
  const bool approximate = !symmetries.exact && symmetries.maps.size() > 1;
  std::vector<Index> numbers(points.size());
  std::iota(numbers.begin(), numbers.end(), Index{0});
  const Nodes nodes(symmetries.exact ? exact_orbits(points, tree, symmetries) : numbers);
  Leaders leaders(points, nodes, symmetries, approximate ? options.resolution : 0,
                  context.stage(0, 0.8));

  FactoredEmbedding embedding;
  embedding.orbits = nodes.of_point;
  if (approximate) {
    std::vector<Index> name(leaders.nodes.size(), -1);
    Index count = 0;
    for (Index& orbit : embedding.orbits) {
      Index& named = name[leaders.nearest[orbit]];
      if (named < 0) named = count++;
      orbit = named;
    }
  }
  embedding.sizes.assign(*std::max_element(embedding.orbits.begin(), embedding.orbits.end()) + 1,
                         0);
  for (const Index orbit : embedding.orbits) ++embedding.sizes[orbit];

  // In place: of a million points it takes 2.4 GB.
  Eigen::MatrixXd& correspondence = leaders.dissimilarity;
  correspondence = (-(correspondence.array() / options.localization).square()).exp();
  Eigen::VectorXd mass = Eigen::VectorXd::Zero(static_cast<Index>(leaders.nodes.size()));
  for (Index a = 0; a < nodes.size(); ++a) mass[leaders.nearest[a]] += nodes.mass[a];
  const Eigen::VectorXd root = mass.cwiseSqrt();
  const Eigen::MatrixXd among = correspondence(leaders.nodes, Eigen::indexing::all);
  const Eigen::MatrixXd scaled =
      root.asDiagonal() * among.cwiseMax(among.transpose()) * root.asDiagonal();
  const auto [values, vectors] =
      eigen_of(scaled, Eigen::MatrixXd::Identity(scaled.rows(), scaled.cols()));
  context.check();
  const Index kept = (values.array() > least_eigenvalue * values[values.size() - 1]).count();
  embedding.eigenvalues = values.tail(kept).reverse();
  const Index given = std::min(kept, options.coordinates);
  const Eigen::MatrixXd carried =
      correspondence * (root.asDiagonal() * vectors.rightCols(given).rowwise().reverse());
  const Eigen::VectorXd weights = embedding.eigenvalues.head(given).array().pow(options.power - 1);
  embedding.coordinates = (carried * weights.asDiagonal())(nodes.of_point, Eigen::indexing::all);
  return embedding;
}

}  // namespace symsurf
