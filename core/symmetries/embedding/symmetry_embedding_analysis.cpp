#include <algorithm>
#include <cmath>
#include <string>

#include "analysis_registry.h"
#include "base/eigenvectors.h"
#include "embedding/factored_embedding.h"

namespace symsurf {

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
  const PointTree tree(points, context.stage(0, 0.1));
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
      "Gives points that symmetries map onto each other the same coordinates, finds their orbits "
      "and what stays in its place.";
  analysis.parameters = {
      Parameter::real("localization", 0.02, 1e-4, 1, "",
                      "Deviation at which points hardly correspond: sigma of the correspondence "
                      "exp(-(S / sigma)^2)."),
      // An eigenvalue is at most the number of points, up to 2^30: the 30th power is finite.
      Parameter::real(
          "power", 1, 0, 30, "",
          "t of the embedding, eigenvalue^t times eigenvector: the higher, the more the "
          "largest orbits count."),
      Parameter::real("tolerance", 0.03, 0, 1, "",
                      "Root mean square deviation up to which a motion or reflection counts, where "
                      "none maps points onto points."),
      Parameter::real("resolution", 0.05, 1e-4, 1, "",
                      "How near an image must come for two points to be of one orbit, where none "
                      "maps points onto points."),
  };
  analysis.arrays = {
      {"orbit", ParameterType::Integer, 1, "The number of its orbit, from 0 on."},
      {"orbit_size", ParameterType::Integer, 1, "How many points the orbit has."},
      {"embedding", ParameterType::Real, shown_coordinates,
       "The first coordinates of the Symmetry Factored Embedding, those of the largest "
       "eigenvalues."},
      {"stationary", ParameterType::Real, 3,
       "The mean of the images of the point, input units: a point of the stationary set."},
      {"stationary_distance", ParameterType::Real, 1,
       "How far that is from the point, input units: 0 where all symmetries keep it."},
  };
  analysis.shown = "orbit";
  analysis.finds_elements = true;
  analysis.finds_transforms = true;
  analysis.run = run_symmetry_embedding;
  return analysis;
}

}  // namespace symsurf
