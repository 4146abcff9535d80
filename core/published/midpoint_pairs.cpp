#include "midpoint_pairs.h"

#include <algorithm>
#include <cmath>

#include "base/eigenvectors.h"
#include "base/parallel.h"
#include "cloud/normals.h"
#include "cloud/surface_points.h"

namespace symsurf {

namespace {

double midpoint_score(PointsView points, const PointTree& tree, const Result& result,
                      const Context& context) {
  constexpr Index neighbours = 11, samples = 2000, grain = 64;
  const PointsView midpoints(result.surface_points);
  if (midpoints.size() < neighbours) return 0;
  const double tolerance = surface_spacing(points, tree);
  if (!(tolerance > 0)) return 0;

  const PointTree midpoint_tree(midpoints, context.stage(0, 0.3));
  const Index stride = std::max<Index>(1, midpoints.size() / samples);
  const Index sampled = (midpoints.size() + stride - 1) / stride;
  const auto agreeing = [&](Index begin, Index end) {
    double sum = 0;
    std::vector<Neighbour> found;
    Eigen::Matrix<double, 3, neighbours - 1> others;
    for (Index k = begin; k < end; ++k) {
      const Index row = k * stride;
      midpoint_tree.nearest(midpoints[row], neighbours, found);
      // The nearest is the midpoint itself, or one equal to it.
      for (Index n = 1; n < neighbours; ++n) others.col(n - 1) = midpoints[found[n].index];
      const Vector3 mean = others.rowwise().mean();
      others.colwise() -= mean;
      const Vector3 normal = eigen_of(Matrix3(others * others.transpose())).vectors.col(0);
      const double off =
          std::hypot(result.residuals[row], 2 * normal.dot(midpoints[row] - mean)) / tolerance;
      const Vector3 chord = points[result.pairs(row, 0)] - points[result.pairs(row, 1)];
      const double moved = std::clamp(chord.norm() / 2 / tolerance - 1, 0.0, 1.0);
      sum += moved * std::exp(-off * off / 2);
    }
    return sum;
  };
  const double sum = parallel_sum(context.stage(0.3, 1), sampled, grain, 0.0, agreeing);

  std::vector<char> paired(points.size(), 0);
  for (const Index i : result.pairs.reshaped()) paired[i] = 1;
  const double covered = static_cast<double>(std::count(paired.begin(), paired.end(), 1)) /
                         static_cast<double>(points.size());
  return covered * sum / static_cast<double>(sampled);
}

}  // namespace

Result midpoint_pairs(PointsView points, const PointTree& tree,
                      const std::vector<Neighbour>& partners, const Context& context) {
  const auto count = std::count_if(partners.begin(), partners.end(),
                                   [](const Neighbour& partner) { return partner.index >= 0; });
  Result result;
  result.pairs.resize(count, 2);
  result.residuals.resize(count);
  result.surface_points.resize(count, 3);
  for (Index i = 0, row = 0; i < points.size(); ++i) {
    const Neighbour& partner = partners[i];
    if (partner.index < 0) continue;
    result.pairs.row(row) << i, partner.index;
    result.residuals[row] = std::sqrt(partner.squared_distance);
    result.surface_points.row(row++) = (points[i] + points[partner.index]).transpose() / 2;
  }
  result.score = midpoint_score(points, tree, result, context);
  return result;
}

std::vector<Parameter> normal_parameters() {
  return {
      Parameter::integer("neighbours", 10, 3, 1000, "points",
                         "Nearest points, the point itself among them, that a normal is estimated "
                         "from."),
      Parameter::choice("normal_estimation", "pca", {"pca", "regression"},
                        "How normals are estimated: by least variance, or by regression of z on x "
                        "and y, which breaks on vertical patches."),
  };
}

Points given_or_estimated_normals(const Cloud& cloud, const PointTree& tree,
                                  const ParameterValues& values, const Context& context) {
  if (cloud.normals.empty())
    return estimate_normals(cloud.points, tree, values.integer("neighbours"),
                            values.choice("normal_estimation"), context);
  Points unit(cloud.normals.size(), 3);
  for (Index i = 0; i < unit.rows(); ++i)
    unit.row(i) = cloud.normals[i].stableNormalized().transpose();
  return unit;
}

}  // namespace symsurf
