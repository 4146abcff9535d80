#include "embedding/factored_embedding.h"

#include <Eigen/SparseCore>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <utility>

#include "base/disjoint_sets.h"
#include "base/linear_algebra.h"
#include "base/math.h"
#include "base/parallel.h"

namespace symsurf {

namespace {

constexpr Index most_orbits = 300;      // without exact partners
constexpr Index most_landmarks = 5000;  // whose matrix is decomposed
constexpr double most_pairs = 3e9;      // of points and images of landmarks: seconds
constexpr double resolved = 0.1;        // localizations from a point to the nearest landmark
constexpr double reach = 4;  // localizations beyond which a correspondence, 1e-7, counts as none
constexpr double least_eigenvalue = 1e-9;  // of the largest: others are rounding
constexpr double partner_reach = 2e-6;     // diameters: twice the rounding of exact maps

// The points that chains of exact partners join, numbered by their first ones.
std::vector<Index> exact_orbits(PointsView points, const PointTree& tree,
                                const NearSymmetries& symmetries) {
  DisjointSets orbits(points.size());
  const double limit = partner_reach * symmetries.diameter;
  for (const Eigen::Isometry3d& map : symmetries.generators)
    for (Index i = 0; i < points.size(); ++i) {
      const Index j = tree.nearest(map * points[i], limit * limit).index;
      if (j >= 0) orbits.join(i, j);
    }
  return orbits.numbered();
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

struct Image {
  double deviation;
  Vector3 at;
};

// Where the symmetries take a point. Of exact ones the points of its orbit stand for it, and the
// inverses are among them; others deviate as much the other way.
std::vector<Image> images_of(const Vector3& x, const NearSymmetries& symmetries) {
  if (symmetries.exact) return {{0, x}};
  std::vector<Image> images;
  for (const auto& [map, deviation] : symmetries.maps) {
    images.push_back({deviation, map * x});
    images.push_back({deviation, map.inverse() * x});
  }
  return images;
}

// Nodes each of which lies farthest, by S in diameters, from those before; the first from the
// centre. A node that is added changes what is farther from those before alone, and is looked for
// there.
struct Landmarks {
  std::vector<Index> nodes;
  std::vector<Index> nearest;  // of each node, by its number among them
  std::vector<Index> orbits;   // the same of the first ones, which the resolution asks for

  Landmarks(PointsView points, const PointTree& tree, const Nodes& all,
            const NearSymmetries& symmetries, const EmbeddingOptions& options,
            const Context& context)
      : nearest(all.size(), 0) {
    Eigen::VectorXd least(all.size());
    for (Index a = 0; a < all.size(); ++a)
      least[a] = (points[all.point[a]] - symmetries.centre).norm();
    double away = infinity;
    const auto images = static_cast<double>(images_of(symmetries.centre, symmetries).size());
    const auto affordable =
        static_cast<Index>(most_pairs / images / static_cast<double>(all.size()));
    const Index most = std::min({most_landmarks, std::max(affordable, most_orbits), all.size()});
    while (size() < most) {
      context.report(static_cast<double>(size()) / static_cast<double>(most));
      Index farthest;
      const double next = least.maxCoeff(&farthest);
      if (!nodes.empty()) away = next;
      if (orbits.empty() && (away <= options.resolution || size() == most_orbits)) orbits = nearest;
      if (away <= resolved * options.localization) break;
      if (nodes.empty()) least.setConstant(infinity);
      for (const Image& image : images_of(points[all.point[farthest]], symmetries)) {
        if (image.deviation > away) continue;
        tree.within(image.at, (away - image.deviation) * symmetries.diameter,
                    [&](Index point, double squared) {
                      const double s = image.deviation + std::sqrt(squared) / symmetries.diameter;
                      const Index node = all.of_point[point];
                      if (s >= least[node]) return;
                      least[node] = s;
                      nearest[node] = size();
                    });
      }
      nodes.push_back(farthest);
    }
    if (orbits.empty()) orbits = nearest;
  }

  Index size() const { return static_cast<Index>(nodes.size()); }
};

using Rows = Eigen::SparseMatrix<double, Eigen::RowMajor, std::int32_t>;

// exp(-(S / localization)^2) of each node, a row, and each landmark near one of its images.
Rows correspondences(PointsView points, const PointTree& tree, const Nodes& all,
                     const Landmarks& landmarks, const NearSymmetries& symmetries,
                     double localization, const Context& context) {
  const Index size = landmarks.size();
  std::vector<Index> number(all.size(), -1);
  for (Index k = 0; k < size; ++k) number[landmarks.nodes[k]] = k;
  std::vector<Vector3> at;
  std::vector<std::pair<Index, double>> images;  // of which landmark, and their deviation
  for (Index i = 0; i < points.size(); ++i)
    if (const Index landmark = number[all.of_point[i]]; landmark >= 0)
      for (const Image& image : images_of(points[i], symmetries)) {
        at.push_back(image.at);
        images.emplace_back(landmark, image.deviation);
      }
  const PointTree image_tree(rows_of(at), context.stage(0, 0.1));
  constexpr Index grain = 256;
  std::vector<std::vector<Eigen::Triplet<double, std::int32_t>>> chunks(points.size() / grain + 1);
  parallel_for(context.stage(0.1, 1), points.size(), grain, [&](Index begin, Index end) {
    std::vector<double> least(size, infinity);
    std::vector<Index> near;
    for (Index k = begin; k < end; ++k) {
      const Index point = tree.order()[k], node = all.of_point[point];
      if (all.point[node] != point) continue;
      near.clear();
      image_tree.within(points[point], reach * localization * symmetries.diameter,
                        [&](Index image, double squared) {
                          const auto& [landmark, deviation] = images[image];
                          if (least[landmark] == infinity) near.push_back(landmark);
                          least[landmark] =
                              std::min(least[landmark],
                                       deviation + std::sqrt(squared) / symmetries.diameter);
                        });
      for (const Index landmark : near) {
        const double s = std::exchange(least[landmark], infinity) / localization;
        if (s < reach) chunks[begin / grain].emplace_back(node, landmark, std::exp(-s * s));
      }
    }
  });
  std::vector<Eigen::Triplet<double, std::int32_t>> entries;
  for (const auto& chunk : chunks) entries.insert(entries.end(), chunk.begin(), chunk.end());
  Rows rows(all.size(), size);
  rows.setFromTriplets(entries.begin(), entries.end());
  return rows;
}

}  // namespace

FactoredEmbedding factored_embedding(PointsView points, const PointTree& tree,
                                     const NearSymmetries& symmetries,
                                     const EmbeddingOptions& options, const Context& context) {
  std::vector<Index> numbers(points.size());
  std::iota(numbers.begin(), numbers.end(), Index{0});
  const Nodes nodes(symmetries.exact ? exact_orbits(points, tree, symmetries) : numbers);
  const Landmarks landmarks(points, tree, nodes, symmetries, options, context.stage(0, 0.3));

  FactoredEmbedding embedding;
  embedding.orbits = nodes.of_point;
  if (!symmetries.exact && symmetries.maps.size() > 1)
    embedding.orbits = renumbered(landmarks.orbits);
  embedding.sizes.assign(*std::max_element(embedding.orbits.begin(), embedding.orbits.end()) + 1,
                         0);
  for (const Index orbit : embedding.orbits) ++embedding.sizes[orbit];

  const Rows rows = correspondences(points, tree, nodes, landmarks, symmetries,
                                    options.localization, context.stage(0.3, 0.6));
  Eigen::VectorXd mass = Eigen::VectorXd::Zero(landmarks.size());
  for (Index a = 0; a < nodes.size(); ++a) mass[landmarks.nearest[a]] += nodes.mass[a];
  const Eigen::VectorXd root = mass.cwiseSqrt();
  Rows among(landmarks.size(), landmarks.size());
  std::vector<Eigen::Triplet<double, std::int32_t>> entries;
  for (Index k = 0; k < landmarks.size(); ++k)
    for (Rows::InnerIterator entry(rows, landmarks.nodes[k]); entry; ++entry)
      entries.emplace_back(k, entry.col(), root[k] * entry.value() * root[entry.col()]);
  among.setFromTriplets(entries.begin(), entries.end());
  const auto [values, vectors] = greatest_eigenpairs(
      among, std::min(options.coordinates, landmarks.size()), context.stage(0.6, 1));
  const Index kept = (values.array() > least_eigenvalue * values[0]).count();
  embedding.eigenvalues = values.head(kept);
  const Eigen::MatrixXd at_landmarks =
      root.asDiagonal() * vectors.leftCols(kept) *
      embedding.eigenvalues.array().pow(options.power - 1).matrix().asDiagonal();
  embedding.coordinates = (rows * at_landmarks)(nodes.of_point, Eigen::indexing::all);
  return embedding;
}

}  // namespace symsurf
