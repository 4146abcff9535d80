#include <algorithm>
#include <cmath>
#include <string>

#include "analysis.h"
#include "base/linear_algebra.h"
#include "base/math.h"
#include "cloud/cloud.h"
#include "cloud/exact_isometries.h"
#include "embedding/factored_embedding.h"

namespace symsurf {

namespace {

constexpr double least_sine = 0.3;                       // of the angle between two base points
constexpr std::size_t most_exact = 512, most_near = 32;  // maps
constexpr Index most_points = 10'000;                    // that approximate maps are found by
constexpr Index landmarks = 120;                         // of points without exact partners
constexpr Index compared = 1000;         // points that an approximate map is fitted to
constexpr std::size_t most_fitted = 96;  // approximate maps that are
constexpr int fitting_steps = 20;
constexpr double same_guess = 0.3;  // of two that are not fitted yet
constexpr double same_map = 0.1;    // Frobenius norm of the difference of two rotations: 4 degrees

using Maps = std::vector<NearSymmetry>;

class NearSearch {
 public:
  NearSearch(PointsView points, const PointTree& tree, const Context& context)
      : points_(points), tree_(tree), context_(context) {
    found_.centre = points.matrix().colwise().mean().transpose();
    rows_ = (points.matrix().rowwise() - found_.centre.transpose()).transpose();
    radii_ = rows_.colwise().norm();
    found_.diameter = 2 * radii_.maxCoeff();
  }

  NearSymmetries exact() {
    const ExactIsometries isometries = exact_isometries(points_, tree_, context_, most_exact);
    found_.centre = isometries.centre;
    for (const Matrix3& linear : isometries.maps) found_.maps.push_back({about_centre(linear), 0});
    for (const Matrix3& linear : isometries.generators) {
      found_.generators.push_back(about_centre(linear));
      found_.exact = found_.exact || moves_points(found_.generators.back());
    }
    return std::move(found_);
  }

  // Beside those that were found.
  NearSymmetries approximate(NearSymmetries found, double tolerance) {
    found_.maps = std::move(found.maps);
    add_near(tolerance);
    found.maps = std::move(found_.maps);
    return found;
  }

 private:
  using Columns = Eigen::Matrix<double, 3, Eigen::Dynamic>;

  bool is_wide(Index a, Index b) const {
    return rows_.col(a).cross(rows_.col(b)).norm() > least_sine * radii_[a] * radii_[b];
  }

  Vector3 image(const Eigen::Isometry3d& map, Index i) const { return map * points_[i]; }

  Eigen::Isometry3d about_centre(const Matrix3& linear) const {
    return map_taking(linear, found_.centre, found_.centre);
  }

  bool moves_points(const Eigen::Isometry3d& map) const {
    for (Index i = 0; i < rows_.cols(); ++i)
      if (tree_.nearest(image(map, i)).index != i) return true;
    return false;
  }

  double deviation(const Eigen::Isometry3d& map, const std::vector<Index>& points) const {
    const Eigen::Isometry3d back = map.inverse();
    double squares = 0;
    for (const Index i : points)
      squares += tree_.nearest(image(map, i)).squared_distance +
                 tree_.nearest(image(back, i)).squared_distance;
    return std::sqrt(squares / (2 * static_cast<double>(points.size()))) / found_.diameter;
  }

  // The orthogonal map that takes points nearest to those nearest to their images (Umeyama 1991).
  Eigen::Isometry3d fitted(Eigen::Isometry3d map, const std::vector<Index>& points) const {
    const double parity = map.linear().determinant() < 0 ? -1 : 1;
    for (int step = 0; step < fitting_steps; ++step) {
      std::vector<std::pair<Vector3, Vector3>> pairs;
      for (const Index i : points)
        pairs.emplace_back(rows_.col(i), rows_.col(tree_.nearest(image(map, i)).index));
      const Eigen::Isometry3d fit = nearest_isometry(pairs, parity);
      map = about_centre(fit.linear());
      map.pretranslate(fit.translation());
    }
    return map;
  }

  void add_near(double tolerance) {
    const std::vector<Index> few =
        farthest_points({rows_.data(), rows_.cols()}, landmarks, context_);
    std::vector<Index> many;
    for (Index i = 0; i < radii_.size(); i += std::max<Index>(1, radii_.size() / compared))
      many.push_back(i);
    const Index a = few.front();
    Index b = -1;
    for (const Index i : few)
      if (is_wide(a, i) && (b < 0 || radii_[i] > radii_[b])) b = i;
    if (b < 0) return;
    // How far an image lies from the nearest landmark at most.
    const double within = (rows_.col(few.back()) - rows_.col(nearest_before(few))).norm();
    const double apart = (rows_.col(a) - rows_.col(b)).norm();
    const Matrix3 base = basis_of(rows_.col(a), rows_.col(b));
    Maps rough;
    for (const Index i : few) {
      context_.check();
      if (std::abs(radii_[i] - radii_[a]) > within) continue;
      for (const Index j : few) {
        if (std::abs(radii_[j] - radii_[b]) > within ||
            !(rows_.col(i).cross(rows_.col(j)).norm() > 0) ||
            std::abs((rows_.col(i) - rows_.col(j)).norm() - apart) > 2 * within)
          continue;
        const Matrix3 onto = basis_of(rows_.col(i), rows_.col(j));
        for (const double side : {1.0, -1.0}) {
          const Eigen::Isometry3d map =
              about_centre(onto * Vector3(1, 1, side).asDiagonal() * base.transpose());
          rough.push_back({map, deviation(map, few)});
        }
      }
    }
    std::stable_sort(rough.begin(), rough.end(), [](const auto& one, const auto& other) {
      return one.deviation < other.deviation;
    });
    suppress_non_maxima(rough, most_fitted, [](const auto& one, const auto& other) {
      return (one.map.linear() - other.map.linear()).norm() < same_guess;
    });
    Maps near;
    for (const NearSymmetry& guess : rough) {
      context_.check();
      const Eigen::Isometry3d map = fitted(guess.map, many);
      near.push_back({map, deviation(map, many)});
    }
    std::stable_sort(near.begin(), near.end(), [](const auto& one, const auto& other) {
      return one.deviation < other.deviation;
    });
    for (const NearSymmetry& map : near) {
      if (map.deviation > tolerance || found_.maps.size() == most_near) break;
      const bool is_known =
          std::any_of(found_.maps.begin(), found_.maps.end(), [&](const NearSymmetry& other) {
            return (other.map.linear() - map.map.linear()).norm() < same_map;
          });
      if (!is_known) found_.maps.push_back(map);
    }
  }

  // Of the landmarks before the last the one nearest to it.
  Index nearest_before(const std::vector<Index>& few) const {
    Index nearest = few.front();
    for (std::size_t k = 0; k + 1 < few.size(); ++k)
      if ((rows_.col(few[k]) - rows_.col(few.back())).norm() <
          (rows_.col(nearest) - rows_.col(few.back())).norm())
        nearest = few[k];
    return nearest;
  }

  PointsView points_;
  const PointTree& tree_;
  const Context& context_;
  Columns rows_;  // the points from their centroid
  Eigen::VectorXd radii_;
  NearSymmetries found_;
};

}  // namespace

NearSymmetries near_symmetries(PointsView points, const PointTree& tree, double tolerance,
                               const Context& context) {
  NearSymmetries found = NearSearch(points, tree, context).exact();
  // Of a planar cloud the reflection in its plane keeps all points in their places.
  if (found.exact) return found;
  std::vector<std::int32_t> rows(std::min(points.size(), most_points));
  for (std::size_t k = 0; k < rows.size(); ++k)
    rows[k] = tree.order()[k * tree.order().size() / rows.size()];
  const Points thinned = chosen_rows(points, rows);
  return NearSearch(thinned, PointTree(thinned, context), context)
      .approximate(std::move(found), tolerance);
}

namespace {

constexpr int shown_coordinates = 16;
constexpr double least_variance = 1e-3;  // Lipman et al.: of the points' own, of a stationary set

double weight_of(const NearSymmetry& symmetry, double localization) {
  const double share = symmetry.deviation / localization;
  return std::exp(-share * share);
}

// Of each point the mean of its images, weighted by how well the maps fit: what all of them keep.
Points orbit_means(PointsView points, const NearSymmetries& symmetries, double localization) {
  Eigen::Matrix<double, 3, 4> sum = Eigen::Matrix<double, 3, 4>::Zero();
  double weights = 0;
  for (const NearSymmetry& symmetry : symmetries.maps) {
    const double weight = weight_of(symmetry, localization);
    sum += weight * symmetry.map.matrix().topRows<3>();
    weights += weight;
  }
  sum /= weights;
  Points means = points.matrix() * sum.leftCols<3>().transpose();
  means.rowwise() += sum.col(3).transpose();
  return means;
}

Index turns_among(const NearSymmetries& symmetries) {
  return std::count_if(
      symmetries.maps.begin(), symmetries.maps.end(),
      [](const NearSymmetry& symmetry) { return symmetry.map.linear().determinant() > 0; });
}

// The set that all symmetries keep in place, by the principal components of the orbits' means.
void add_stationary_set(PointsView points, const Points& means, const NearSymmetries& symmetries,
                        AnalysisResult& result) {
  const Vector3 centre = means.colwise().mean().transpose();
  const Points own = points.matrix().rowwise() - points.matrix().colwise().mean();
  const SymmetricEigen<3> principal =
      eigen_of_scatter(Points(means.rowwise() - centre.transpose()));
  const Vector3 variances = principal.values.reverse() / own.squaredNorm();
  constexpr const char* names[] = {"point", "line", "plane", "none"};
  const Index extent = (variances.array() > least_variance).count();
  if (extent == 1)
    result.axes.push_back({centre, principal.vectors.col(2), turns_among(symmetries)});
  if (extent == 2) {
    const Vector3 normal = principal.vectors.col(0);
    result.planes.push_back({normal, -normal.dot(centre)});
  }
  result.statistics["stationary_set"] = std::string(names[extent]);
  result.statistics["stationary_variances"] = variances;
  result.statistics["centre"] = centre;
}

void run_symmetry_embedding(const ColouredCloud& cloud, const ParameterValues& values,
                            const Context& context, AnalysisResult& result) {
  const PointsView points = cloud.points;
  const PointTree& tree = cloud.tree(context.stage(0, 0.1));
  const EmbeddingOptions options{values.real("localization"), values.real("power"),
                                 values.real("resolution"), shown_coordinates};
  const NearSymmetries symmetries =
      near_symmetries(points, tree, values.real("tolerance"), context.stage(0.1, 0.4));
  const FactoredEmbedding embedding =
      factored_embedding(points, tree, symmetries, options, context.stage(0.4, 1));
  const Points means = orbit_means(points, symmetries, options.localization);

  Eigen::MatrixXd orbit(points.size(), 1), size(points.size(), 1);
  for (Index i = 0; i < points.size(); ++i) {
    orbit(i) = static_cast<double>(embedding.orbits[i]);
    size(i) = static_cast<double>(embedding.sizes[embedding.orbits[i]]);
  }
  Eigen::MatrixXd coordinates = Eigen::MatrixXd::Zero(points.size(), shown_coordinates);
  coordinates.leftCols(embedding.coordinates.cols()) = embedding.coordinates;
  result.arrays = {{"orbit", orbit},
                   {"orbit_size", size},
                   {"embedding", coordinates},
                   {"stationary", means},
                   {"stationary_distance", (points.matrix() - means).rowwise().norm()}};
  // Radians and diameters: exact maps are exact to 1e-6, fitted ones miss by the noise.
  const double missed = symmetries.exact ? 1e-4 : 0.02;
  for (const NearSymmetry& symmetry : symmetries.maps)
    result.transformations.push_back(
        {kind_of(symmetry.map.matrix(), symmetries.centre, missed, missed * symmetries.diameter),
         symmetry.map.matrix(),
         weight_of(symmetry, options.localization),
         {},
         {}});
  result.statistics = {{"orbits", static_cast<Index>(embedding.sizes.size())},
                       {"exact", symmetries.exact},
                       {"symmetries", static_cast<Index>(symmetries.maps.size())},
                       {"eigenvalues", Eigen::MatrixXd(embedding.eigenvalues)},
                       {"diameter", symmetries.diameter}};
  add_stationary_set(points, means, symmetries, result);
}

}  // namespace

AnalysisImplementation symmetry_embedding_analysis() {
  AnalysisImplementation analysis;
  analysis.name = "symmetry_embedding";
  analysis.title = "Symmetry factored embedding";
  analysis.summary =
      "Computes coordinates that are equal for points that symmetries map onto each other, the "
      "orbits of these points, and the points that all symmetries fix.";
  analysis.parameters = {
      Parameter::real("localization", 0.02, 1e-4, 1, "",
                      "Deviation at which points hardly correspond: sigma of the correspondence "
                      "exp(-(S / sigma)^2)."),
      // An eigenvalue is at most the number of points, up to 2^30: the 30th power is finite.
      Parameter::real("power", 1, 0, 30, "",
                      "t of the embedding, eigenvalue^t times eigenvector: higher values weigh "
                      "large orbits more."),
      Parameter::real("tolerance", 0.03, 0, 1, "",
                      "Root mean square deviation up to which a motion or reflection counts as a "
                      "symmetry, if none maps points exactly onto points."),
      Parameter::real("resolution", 0.05, 1e-4, 1, "",
                      "Maximum distance between an image and a point of the same orbit, if no "
                      "symmetry maps points exactly onto points."),
  };
  analysis.arrays = {
      {"orbit", ParameterType::Integer, 1, "Index of the orbit of the point, from 0."},
      {"orbit_size", ParameterType::Integer, 1, "Number of points in the orbit."},
      {"embedding", ParameterType::Real, shown_coordinates,
       "The first coordinates of the Symmetry Factored Embedding, those of the largest "
       "eigenvalues."},
      {"stationary", ParameterType::Real, 3,
       "The mean of the images of the point, input units: a point of the stationary set."},
      {"stationary_distance", ParameterType::Real, 1,
       "Distance from the point to that mean, input units: 0 if all symmetries fix it."},
  };
  analysis.shown = "orbit";
  analysis.finds_elements = true;
  analysis.finds_transforms = true;
  analysis.run = run_symmetry_embedding;
  return analysis;
}

}  // namespace symsurf
