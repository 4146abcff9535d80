#include "symmetries/intrinsic/functional_map.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>

#include "base/eigenvectors.h"
#include "base/math.h"
#include "base/parallel.h"
#include "spatial/kd_tree.h"

namespace symsurf {

SampledFunctions::SampledFunctions(const SurfaceBasis& basis, const std::vector<Index>& vertices,
                                   Eigen::VectorXd weights)
    : values_(basis.functions(vertices, Eigen::indexing::all)), weights_(std::move(weights)) {}

std::vector<Index> SampledFunctions::images(const FunctionalMap& map) const {
  const auto functions = values_.leftCols(map.rows());
  // |f(y) - g|^2 - |g|^2, a column for each mapped g.
  const Eigen::MatrixXd mapped = (functions * map).transpose();
  Eigen::MatrixXd distances = -2 * functions * mapped;
  distances.colwise() += functions.rowwise().squaredNorm();
  std::vector<Index> nearest(values_.rows());
  for (Index i = 0; i < values_.rows(); ++i) distances.col(i).minCoeff(&nearest[i]);
  return nearest;
}

FunctionalMap SampledFunctions::fitted(const std::vector<Index>& images, Index count) const {
  const auto functions = values_.leftCols(count);
  const Eigen::MatrixXd at_images = weights_.asDiagonal() * functions(images, Eigen::indexing::all);
  // The nearest orthogonal matrix, 0 along what the products say nothing about (Higham 1986).
  const Eigen::MatrixXd products = functions.transpose() * at_images;
  const auto [squares, vectors] = eigen_of(Eigen::MatrixXd(products.transpose() * products));
  const double least =
      static_cast<double>(count) * std::numeric_limits<double>::epsilon() * squares.maxCoeff();
  const Eigen::VectorXd inverse =
      (squares.array() > least).select(squares.array().max(least).rsqrt(), 0.0);
  return products * vectors * inverse.asDiagonal() * vectors.transpose();
}

FunctionalMap SampledFunctions::refined(std::vector<Index> from, Index first, Index last,
                                        Index step, const Context& context) const {
  FunctionalMap map;
  for (Index count = std::min(first, last);; count = std::min(count + step, last)) {
    context.check();
    map = fitted(from, count);
    if (count == last) return map;
    from = images(map);
  }
}

std::vector<Index> all_images(const SurfaceBasis& basis, const FunctionalMap& map,
                              const Context& context) {
  constexpr int dimension = 60;  // as many functions as are used, fewer filled up with zeros
  using Tree = KdTree<dimension>;
  const Index used = map.rows(), size = basis.functions.rows();
  const auto row = [&](const auto& values) {
    Tree::Point point = Tree::Point::Zero();
    point.head(used) = values.transpose();
    return point;
  };
  std::vector<Tree::Point> points;
  for (Index v = 0; v < size; ++v) points.push_back(row(basis.functions.row(v).head(used)));
  const Tree tree(std::move(points), context);
  const Eigen::MatrixXd mapped = basis.functions.leftCols(used) * map;
  std::vector<Index> images(size);
  parallel_for(context, size, 256, [&](Index begin, Index end) {
    for (Index v = begin; v < end; ++v) {
      double nearest = std::numeric_limits<double>::infinity();
      const auto offer = [&](Index image, double squared) {
        if (squared < nearest || (squared == nearest && image < images[v])) {
          nearest = squared;
          images[v] = image;
        }
        return Tree::at_most(nearest);
      };
      tree.search(row(mapped.row(v)), nearest, offer);
    }
  });
  return images;
}

namespace {

constexpr Index most_products = 10;  // functions whose products tell the orientation
constexpr Index most_signs = 8;      // functions all of whose signs are tried
constexpr Index looked_at = 16;      // among the first so many
constexpr Index fewest_signs = 3;    // with which a map is determined
// Shares of an eigenvalue that it is away from others. A pose mixes functions whose eigenvalues are
// near each other, yet such functions may be all that distinguishes two limbs: each share is tried.
constexpr double alone = 0.02;
constexpr std::array<double, 3> shares_alone{alone, 0.002, 0.05};
constexpr std::size_t most_starts = 24;  // a share
constexpr Index told_apart_by = 20;      // functions: maps alike in these are refined to one
constexpr Index refined_to = 40;         // functions
// More functions at a time: each way finds maps that the other misses.
constexpr std::array<Index, 2> steps{1, 2};
constexpr int rounds = 3;            // by distances; they settle in two or three
constexpr double most_change = 0.1;  // of a distance, in longest ones, that counts
constexpr double most_kept = 0.6;    // orientation beyond which no round reverses it
constexpr double same_map = 0.3;     // of the norm of the difference of unrelated maps
constexpr double least_reversal = 0.3;
constexpr double least_move = 0.03;  // in longest distances; the identity moves nothing

// Whether a map of a surface onto itself turns it over, as reflections do, by the products
// df ^ dg of eigenfunctions' differentials: isometries keep them up to this sign.
class Orientation {
 public:
  Orientation(const ConnectedSurface& surface, const SurfaceBasis& basis,
              const SampledPoints& samples);

  // The mean correlation of the products before and after: 1 for an isometry that keeps the
  // orientation, -1 for one that reverses it; 0 without triangles. `images`: of the samples, by
  // their positions among these.
  double of(const FunctionalMap& map, const std::vector<Index>& images) const;

 private:
  using Rows = Eigen::MatrixXd;

  // Means about each sample of the products of each pair of functions, a row a sample.
  Rows products(const Rows& functions) const;

  std::vector<Index> vertices_;    // of the triangles at samples
  std::vector<Triangles> around_;  // those of each sample, by positions among the vertices
  Rows values_;                    // of the basis, at the vertices
  Eigen::VectorXd weights_;
  Rows own_;  // products of the basis's functions
};

Orientation::Orientation(const ConnectedSurface& surface, const SurfaceBasis& basis,
                         const SampledPoints& samples)
    : weights_(samples.weights) {
  std::vector<Index> sample_of(surface.points.rows(), -1), position(surface.points.rows(), -1);
  for (std::size_t s = 0; s < samples.vertices.size(); ++s)
    sample_of[samples.vertices[s]] = static_cast<Index>(s);
  std::vector<std::vector<std::array<Index, 3>>> around(samples.vertices.size());
  for (Index t = 0; t < surface.triangles.rows(); ++t)
    for (int c = 0; c < 3; ++c) {
      const Index sample = sample_of[surface.triangles(t, c)];
      if (sample < 0) continue;
      std::array<Index, 3>& corners = around[sample].emplace_back();
      for (int k = 0; k < 3; ++k) {
        Index& at = position[surface.triangles(t, k)];
        if (at < 0) {
          at = static_cast<Index>(vertices_.size());
          vertices_.push_back(surface.triangles(t, k));
        }
        corners[k] = at;
      }
    }
  for (const auto& triangles : around) around_.push_back(rows_of(triangles));
  values_ = basis.functions(vertices_, Eigen::indexing::all);
  own_ = products(values_.leftCols(std::min(most_products, values_.cols())));
}

Orientation::Rows Orientation::products(const Rows& functions) const {
  const Index count = functions.cols();
  Rows means = Rows::Zero(static_cast<Index>(around_.size()), count * (count - 1) / 2);
  for (Index s = 0; s < means.rows(); ++s) {
    for (Index t = 0; t < around_[s].rows(); ++t) {
      const auto corners = around_[s].row(t);
      const Eigen::RowVectorXd one = functions.row(corners[1]) - functions.row(corners[0]);
      const Eigen::RowVectorXd other = functions.row(corners[2]) - functions.row(corners[0]);
      Index pair = 0;
      for (Index f = 0; f < count; ++f)
        for (Index g = 0; g < f; ++g) means(s, pair++) += one[f] * other[g] - one[g] * other[f];
    }
    if (around_[s].rows() > 0) means.row(s) /= static_cast<double>(around_[s].rows());
  }
  return means;
}

double Orientation::of(const FunctionalMap& map, const std::vector<Index>& images) const {
  const Index count = std::min({most_products, values_.cols(), map.cols()});
  const Rows mapped = products(values_.leftCols(map.rows()) * map.leftCols(count));
  double sum = 0;
  for (Index pair = 0; pair < mapped.cols(); ++pair) {
    const Eigen::VectorXd here = mapped.col(pair), there = own_(images, pair);
    const double squares = weights_.dot(here.cwiseAbs2()) * weights_.dot(there.cwiseAbs2());
    if (squares > 0) sum += weights_.dot(here.cwiseProduct(there)) / std::sqrt(squares);
  }
  return mapped.cols() == 0 ? 0 : sum / static_cast<double>(mapped.cols());
}

// The functions whose eigenvalues stand alone, so that a symmetry can but change their signs.
std::vector<Index> functions_alone(const Eigen::VectorXd& values, double share) {
  std::vector<Index> found;
  for (Index k = 0; k + 1 < std::min(looked_at + 1, values.size()); ++k) {
    const double below = k == 0 ? values[0] : values[k] - values[k - 1];
    if (std::min(below, values[k + 1] - values[k]) > share * values[k]) found.push_back(k);
    if (static_cast<Index>(found.size()) == most_signs) break;
  }
  return found;
}

struct Start {
  double distance;  // mean, between mapped functions and those at the images
  std::string signs;
  std::vector<Index> images;
};

std::string signs_of(const std::vector<Index>& functions, std::uint32_t odd) {
  std::string signs(functions.back() + 1, '0');
  for (std::size_t k = 0; k < functions.size(); ++k) signs[functions[k]] = odd >> k & 1 ? '-' : '+';
  return signs;
}

FunctionalMap signed_map(const std::string& signs) {
  Eigen::VectorXd diagonal(static_cast<Index>(signs.size()));
  for (std::size_t k = 0; k < signs.size(); ++k)
    diagonal[static_cast<Index>(k)] = signs[k] == '0' ? 0 : signs[k] == '+' ? 1 : -1;
  return diagonal.asDiagonal();
}

// Of all signs but the identity's, in Gray's order, so that one sign changes at a time; the best
// first.
std::vector<Start> promising_starts(const SurfaceBasis& basis, const SampledPoints& samples,
                                    const Orientation& orientation,
                                    const std::vector<Index>& functions, const Context& context) {
  std::vector<Eigen::MatrixXd> odd_less_even;
  Eigen::MatrixXd distances = Eigen::MatrixXd::Zero(samples.weights.size(), samples.weights.size());
  for (const Index k : functions) {
    // In the global point signature's weights (Rustamov 2007).
    const Eigen::VectorXd f = basis.functions(samples.vertices, k) / std::sqrt(basis.values[k]);
    const Index size = f.size();
    const Eigen::MatrixXd across = f.transpose().replicate(size, 1);
    distances += (across.colwise() - f).cwiseAbs2();
    odd_less_even.push_back(4 * f * f.transpose());
  }
  std::vector<Start> starts;
  std::uint32_t odd = 0;
  for (std::uint32_t k = 1; k < 1u << functions.size(); ++k) {
    context.check();
    const int changed = std::countr_zero(k);
    odd ^= 1u << changed;
    distances += (odd >> changed & 1 ? 1 : -1) * odd_less_even[changed];
    Start start{0, signs_of(functions, odd), std::vector<Index>(distances.cols())};
    for (Index i = 0; i < distances.cols(); ++i)
      start.distance += samples.weights[i] *
                        std::sqrt(std::max(0.0, distances.col(i).minCoeff(&start.images[i])));
    starts.push_back(std::move(start));
  }
  std::stable_sort(starts.begin(), starts.end(),
                   [](const Start& a, const Start& b) { return a.distance < b.distance; });
  std::vector<Start> reversing;
  for (Start& start : starts) {
    if (reversing.size() == most_starts) break;
    if (orientation.of(signed_map(start.signs), start.images) < 0)
      reversing.push_back(std::move(start));
  }
  return reversing;
}

// Of each sample the one whose distances to all images are most like its own to all: an isometry
// keeps them. That sets limbs right which functions that a pose has mixed lead astray.
std::vector<Index> images_by_distances(const SampledPoints& samples,
                                       const std::vector<Index>& images) {
  // A column a sample; the distances are symmetric.
  const Eigen::MatrixXd to_images = samples.distances(images, Eigen::indexing::all);
  std::vector<Index> nearest(images.size());
  for (Index i = 0; i < samples.distances.cols(); ++i) {
    const Eigen::RowVectorXd change =
        samples.weights.transpose() *
        (to_images.colwise() - samples.distances.col(i)).cwiseAbs().cwiseMin(most_change);
    change.minCoeff(&nearest[i]);
  }
  return nearest;
}

IntrinsicMap judged(FunctionalMap map, const SampledFunctions& sampled,
                    const SampledPoints& samples, const Orientation& orientation) {
  const std::vector<Index> images = sampled.images(map);
  const Eigen::MatrixXd after = samples.distances(images, images);
  const Eigen::VectorXd& weights = samples.weights;
  IntrinsicMap judged;
  judged.distortion = weights.dot((after - samples.distances).cwiseAbs() * weights);
  for (std::size_t i = 0; i < images.size(); ++i)
    judged.moved +=
        weights[static_cast<Index>(i)] * samples.distances(static_cast<Index>(i), images[i]);
  judged.orientation = orientation.of(map, images);
  judged.map = std::move(map);
  return judged;
}

bool is_better(const IntrinsicMap& one, const IntrinsicMap& other) {
  const auto cost = [](const IntrinsicMap& map) {
    const double reversal = std::min(1.0, -map.orientation);
    // A front mirrored to a back changes little, as it moves little. Bent limbs change distances
    // more than limbs that are mapped onto themselves; the orientation excludes these: its cube
    // counts.
    return reversal < least_reversal
               ? INFINITY
               : map.distortion / (map.moved * reversal * reversal * reversal);
  };
  return cost(one) < cost(other);
}

}  // namespace

IntrinsicMap search_map(const ConnectedSurface& surface, const SurfaceBasis& basis,
                        const SampledPoints& samples, const Context& context) {
  IntrinsicMap best;
  if (static_cast<Index>(functions_alone(basis.values, alone).size()) < fewest_signs) return best;
  const Orientation orientation(surface, basis, samples);
  std::vector<Start> starts;
  for (const double share : shares_alone) {
    const std::vector<Index> functions = functions_alone(basis.values, share);
    if (static_cast<Index>(functions.size()) < fewest_signs) continue;
    for (Start& start : promising_starts(basis, samples, orientation, functions, context)) {
      const bool is_new = std::none_of(starts.begin(), starts.end(), [&](const Start& other) {
        return other.signs == start.signs;
      });
      if (is_new) starts.push_back(std::move(start));
    }
  }
  const SampledFunctions sampled(basis, samples.vertices, samples.weights);
  const Index last = std::min(refined_to, basis.count());
  const Index apart = std::min(told_apart_by, last);
  std::vector<FunctionalMap> seen;
  best.signs = starts.empty() ? "0" : starts.front().signs;  // no map may come of them
  for (std::size_t k = 0; k < starts.size(); ++k) {
    context.report(static_cast<double>(k) / static_cast<double>(starts.size()));
    for (const Index step : steps) {
      const auto first = static_cast<Index>(starts[k].signs.size());
      FunctionalMap map = sampled.refined(starts[k].images, first, apart, step, context);
      const double unrelated = std::sqrt(2.0 * static_cast<double>(apart));
      const bool is_new = std::none_of(seen.begin(), seen.end(), [&](const FunctionalMap& other) {
        return (map - other).norm() < same_map * unrelated;
      });
      if (!is_new) continue;
      seen.push_back(map);
      map = sampled.refined(sampled.images(map), apart, last, step, context);
      for (int round = 0;; ++round) {
        IntrinsicMap found = judged(map, sampled, samples, orientation);
        found.signs = starts[k].signs;
        const bool is_hopeless = found.orientation > most_kept;
        if (found.moved >= least_move && (best.map.size() == 0 || is_better(found, best)))
          best = std::move(found);
        if (round == rounds || is_hopeless) break;
        map = sampled.fitted(images_by_distances(samples, sampled.images(map)), last);
      }
    }
  }
  return best;
}

}  // namespace symsurf
