#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>

#include "base/linear_algebra.h"
#include "base/math.h"
#include "base/parallel.h"
#include "intrinsic/intrinsic_symmetry.h"

namespace symsurf {

namespace {

constexpr double rounding = 1e-12;  // of residuals of flat patches, which both maps fit
constexpr Index fewest = 6;  // samples of a patch: three determine a reflection, noise asks more

}  // namespace

Patches::Patches(const ConnectedSurface& surface, const SampledPoints& samples,
                 const PointTree& vertices, double radius)
    : surface_(surface), samples_(samples), vertices_(vertices) {
  for (Index j = 0; j < samples.count(); ++j) {
    Eigen::VectorXd ascending = samples.distances.col(j);
    const Index last = std::min(fewest, samples.count() - 1);
    std::nth_element(ascending.begin(), ascending.begin() + last, ascending.end());
    radii_.push_back(std::max(radius, ascending[last]));
    std::vector<Member>& patch = patches_.emplace_back();
    for (Index i = 0; i < samples.count(); ++i) {
      const double weight = biweight(samples.distances(i, j) / radii_.back()) * samples.weights[i];
      if (weight > 0) patch.push_back({i, weight});
    }
  }
}

// Of a patch and its image, about their means.
struct Patches::Moments {
  Vector3 mean = Vector3::Zero(), image = Vector3::Zero();
  Matrix3 products = Matrix3::Zero();  // of the images and the samples
  double before = 0, after = 0;        // sums of squares
};

Patches::Moments Patches::moments(const std::vector<Member>& patch,
                                  const std::vector<Index>& images) const {
  const auto at = [&](Index vertex) -> Vector3 { return surface_.points.row(vertex).transpose(); };
  Moments sums;
  double weights = 0;
  for (const auto& [i, weight] : patch) {
    weights += weight;
    sums.mean += weight * at(samples_.vertices[i]);
    sums.image += weight * at(images[i]);
  }
  if (weights == 0) return sums;
  sums.mean /= weights;
  sums.image /= weights;
  for (const auto& [i, weight] : patch) {
    const Vector3 x = at(samples_.vertices[i]) - sums.mean, y = at(images[i]) - sums.image;
    const double share = weight / weights;
    sums.products += share * y * x.transpose();
    sums.before += share * x.squaredNorm();
    sums.after += share * y.squaredNorm();
  }
  return sums;
}

// Mean square distance from turned or reflected samples to their images, in that of the samples.
double Patches::residual(const Moments& sums, double parity) {
  const Matrix3 fit = nearest_orthogonal(sums.products, parity);
  return std::max(0.0, sums.before + sums.after - 2 * fit.cwiseProduct(sums.products).sum()) /
         sums.before;
}

PatchChange Patches::change(const std::vector<Index>& images) const {
  PatchChange change;
  double reflected = 0, turned = 0;
  for (Index j = 0; j < samples_.count(); ++j) {
    const Moments sums = moments(patches_[j], images);
    if (!(sums.before > 0)) continue;
    const double by_reflection = residual(sums, -1);
    change.bending += samples_.weights[j] * std::sqrt(by_reflection);
    reflected += samples_.weights[j] * by_reflection;
    turned += samples_.weights[j] * residual(sums, 1);
  }
  if (reflected + turned > rounding)
    change.handedness = (turned - reflected) / (turned + reflected);
  return change;
}

std::vector<Eigen::Isometry3d> Patches::reflections(const std::vector<Index>& images) const {
  std::vector<Eigen::Isometry3d> fitted;
  for (const std::vector<Member>& patch : patches_) {
    const Moments sums = moments(patch, images);
    fitted.push_back(map_taking(nearest_orthogonal(sums.products, -1), sums.mean, sums.image));
  }
  return fitted;
}

Index Patches::image(const std::vector<Eigen::Isometry3d>& reflections, Index vertex) const {
  const Vector3 x = surface_.points.row(vertex).transpose();
  Vector3 sum = Vector3::Zero();
  double weights = 0;
  for (Index j = 0; j < samples_.count(); ++j) {
    const double weight = biweight(samples_.to_all(vertex, j) / radii_[j]);
    if (weight == 0) continue;
    weights += weight;
    sum += weight * (reflections[j] * x);
  }
  return vertices_
      .nearest(weights > 0 ? Vector3(sum / weights) : reflections[samples_.nearest[vertex]] * x)
      .index;
}

std::vector<Index> Patches::refined(std::vector<Index> images, int rounds) const {
  for (int round = 0; round < rounds; ++round) {
    const std::vector<Eigen::Isometry3d> fitted = reflections(images);
    for (Index i = 0; i < samples_.count(); ++i) images[i] = image(fitted, samples_.vertices[i]);
  }
  return images;
}

Patches::Extended Patches::extended(const std::vector<Index>& images,
                                    const Context& context) const {
  Extended map;
  map.patches_ = this;
  map.reflections_ = reflections(images);
  map.images_.resize(surface_.points.rows());
  parallel_for(context, surface_.points.rows(), 256, [&](Index begin, Index end) {
    for (Index v = begin; v < end; ++v) map.images_[v] = image(map.reflections_, v);
  });
  return map;
}

Vector3 Patches::Extended::image(const Vector3& x, Index vertex) const {
  const Points& points = patches_->surface_.points;
  const Vector3 off = x - points.row(vertex).transpose();
  return points.row(images_[vertex]).transpose() +
         reflections_[patches_->samples_.nearest[vertex]].linear() * off;
}

namespace {

// A map of a surface onto itself, x -> T x, as the matrix with f(T x) = C' f(x) for the first
// eigenfunctions f (Ovsjanikov et al. 2012). It is orthogonal, as the map is an isometry.
using FunctionalMap = Eigen::MatrixXd;

// Values of functions at vertices with their weights, and where a map sends each of these.
class SampledFunctions {
 public:
  // Of so many vertices of the basis.
  SampledFunctions(const SurfaceBasis& basis, const std::vector<Index>& vertices,
                   Eigen::VectorXd weights);

  // Of each vertex the one, by its position among them, where the first functions are nearest to
  // the mapped ones.
  std::vector<Index> images(const FunctionalMap& map) const;

  // The orthogonal map of the first `count` functions that fits the images best (Procrustes).
  FunctionalMap fitted(const std::vector<Index>& images, Index count) const;

  // Images and map by turns, of more functions each time (Melzi et al. 2019, ZoomOut).
  FunctionalMap refined(std::vector<Index> images, Index first, Index last, Index step,
                        const Context& context) const;

 private:
  Eigen::MatrixXd values_;  // a row a vertex
  Eigen::VectorXd weights_;
};

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

constexpr Index most_signs = 8;    // functions all of whose signs are tried
constexpr Index looked_at = 16;    // among the first so many
constexpr Index fewest_signs = 3;  // with which a map is determined
// Shares of an eigenvalue that it is away from others. A pose mixes functions whose eigenvalues are
// near each other, yet such functions may be all that distinguishes two limbs: each share is tried.
constexpr double alone = 0.02;
constexpr std::array<double, 3> shares_alone{alone, 0.002, 0.05};
constexpr std::size_t most_starts = 24;  // a share
constexpr Index told_apart_by = 20;      // functions: maps alike in these are refined to one
// More functions at a time: each way finds maps that the other misses.
constexpr std::array<Index, 2> steps{1, 2};
constexpr int rounds = 3;            // by distances; they settle in two or three
constexpr double most_change = 0.1;  // of a distance, in longest ones, that counts
// Patches as flat as sheets are fitted by reflections and by turns alike, but for noise.
constexpr double least_handedness = -0.1;
constexpr double same_map = 0.3;     // of the norm of the difference of unrelated maps
constexpr double least_move = 0.03;  // in longest distances; the identity moves nothing
constexpr double apart_by = 0.03;    // mean, in longest distances, of maps that are two
constexpr std::size_t most_maps = 24;

std::vector<Index> vertices_of(const std::vector<Index>& of, const SampledPoints& samples) {
  std::vector<Index> vertices;
  for (const Index i : of) vertices.push_back(samples.vertices[i]);
  return vertices;
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

// Of all signs but the identity's, in Gray's order, so that one sign changes at a time; the best
// first.
std::vector<Start> promising_starts(const SurfaceBasis& basis, const SampledPoints& samples,
                                    const Patches& patches, const std::vector<Index>& functions,
                                    const Context& context) {
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
    if (patches.change(vertices_of(start.images, samples)).handedness > least_handedness)
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

// The best of maps that are alike, the best first; but for the first those that may turn the
// surface over.
std::vector<IntrinsicMap> distinct(std::vector<IntrinsicMap> maps, const SampledPoints& samples) {
  std::stable_sort(maps.begin(), maps.end(), is_better);
  const auto difference = [&](const IntrinsicMap& one, const IntrinsicMap& other) {
    double sum = 0;
    for (Index i = 0; i < samples.count(); ++i)
      sum += samples.weights[i] *
             samples.distances(samples.nearest[one.images[i]], samples.nearest[other.images[i]]);
    return sum;
  };
  std::vector<IntrinsicMap> kept;
  for (IntrinsicMap& map : maps) {
    if (!kept.empty() && (kept.size() == most_maps || !is_better(map, {}))) break;
    const bool is_new = std::none_of(kept.begin(), kept.end(), [&](const IntrinsicMap& other) {
      return difference(map, other) < apart_by;
    });
    if (is_new) kept.push_back(std::move(map));
  }
  return kept;
}

}  // namespace

bool is_better(const IntrinsicMap& one, const IntrinsicMap& other) {
  const auto cost = [](const IntrinsicMap& map) {
    // A front mirrored to a back changes little, as it moves little. Patches of what turns rather
    // than mirrors are bent most.
    return map.change.handedness > least_handedness && map.moved >= least_move
               ? map.distortion * map.change.bending / map.moved
               : infinity;
  };
  return cost(one) < cost(other);
}

void set_images(std::vector<Index> images, const SampledPoints& samples, const Patches& patches,
                IntrinsicMap& map) {
  std::vector<Index> nearest;  // samples
  for (const Index v : images) nearest.push_back(samples.nearest[v]);
  const Eigen::MatrixXd after = samples.distances(nearest, nearest);
  const Eigen::VectorXd& weights = samples.weights;
  map.distortion = weights.dot((after - samples.distances).cwiseAbs() * weights);
  map.moved = 0;
  for (Index i = 0; i < samples.count(); ++i)
    map.moved += weights[i] * samples.distances(i, nearest[i]);
  map.change = patches.change(images);
  map.images = std::move(images);
}

std::vector<IntrinsicMap> search_maps(const SurfaceBasis& basis, const SampledPoints& samples,
                                      const Patches& patches, const Context& context) {
  if (static_cast<Index>(functions_alone(basis.values, alone).size()) < fewest_signs) return {};
  std::vector<Start> starts;
  for (const double share : shares_alone) {
    const std::vector<Index> functions = functions_alone(basis.values, share);
    if (static_cast<Index>(functions.size()) < fewest_signs) continue;
    for (Start& start : promising_starts(basis, samples, patches, functions, context)) {
      const bool is_new = std::none_of(starts.begin(), starts.end(), [&](const Start& other) {
        return other.signs == start.signs;
      });
      if (is_new) starts.push_back(std::move(start));
    }
  }
  const SampledFunctions sampled(basis, samples.vertices, samples.weights);
  const Index last = basis.count(), apart = std::min(told_apart_by, last);
  std::vector<FunctionalMap> seen;
  std::vector<IntrinsicMap> found;
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
        const std::vector<Index> images = sampled.images(map);
        IntrinsicMap& one = found.emplace_back();
        one.signs = starts[k].signs;
        set_images(vertices_of(images, samples), samples, patches, one);
        if (round == rounds || one.change.handedness < least_handedness) break;
        map = sampled.fitted(images_by_distances(samples, images), last);
      }
    }
  }
  return distinct(std::move(found), samples);
}

}  // namespace symsurf
