#include "refinement.h"

#include <Eigen/Eigenvalues>
#include <array>

#include "../sheet_spacing.h"

namespace symsurf {

ParametricRefinement::ParametricRefinement(const Cloud& cloud, const NearestPoints& points,
                                           const PointTree& tree, const Surfels& surfels,
                                           const Context& context)
    : cloud_(cloud),
      points_(points),
      surfels_(surfels),
      context_(context),
      spacing_(sheet_spacing(cloud.points, tree) / cloud.frame.size) {
  constexpr Index most_samples = 8192;
  const Index n = cloud.points.size(), count = std::min(n, most_samples);
  for (Index k = 0; k < count; ++k) {
    const Vector3 x = cloud.frame.enter(cloud.points[tree.order()[k * n / count]]);
    const Index surfel = surfels.containing(x);
    if (surfel >= 0) samples_.push_back({x, &surfels[surfel]});
  }
}

Index ParametricRefinement::stride_for(Index wanted) const {
  return std::max<Index>(1, static_cast<Index>(samples_.size()) / wanted);
}

Eigen::Matrix<double, Eigen::Dynamic, 2> ParametricRefinement::loosest(const Eigen::MatrixXd& held,
                                                                       Eigen::MatrixXd moved,
                                                                       double count) {
  if (!(count > 0)) return Eigen::Matrix<double, Eigen::Dynamic, 2>::Zero(moved.rows(), 2);
  moved /= count;
  moved.diagonal().array() += 1e-9 * moved.trace();
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> eigen(held, moved);
  return eigen.eigenvectors().leftCols(2);
}

// The mean over tolerances from coarse to fine: images that meet a point exactly count in full,
// chance agreement less the finer one looks.
double ParametricRefinement::closeness(const Agreement& agreement) {
  constexpr std::array score_tolerances{0.01, 0.005, 0.0025, 0.00125};
  double sum = 0;
  for (const double tolerance : score_tolerances) sum += agreement.weight(tolerance);
  return sum / static_cast<double>(score_tolerances.size());
}

}  // namespace symsurf
