#include "methods/sphere/support_maximum.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/quadratic_fit.h"
#include "base/symmetric_eigen.h"

namespace symsurf {

namespace {

constexpr std::array rounds{1.0, 0.6};                               // their steps, in spacings
constexpr int few = 2;                                               // steps to either side
constexpr Index compared = 1200, refitted = 800, look_again = 3000;  // samples

// Where in the square from -1 to 1 a quadratic is highest that fits values there by least squares;
// along an axis where it has no maximum, on the side that it rises to.
Eigen::Vector2d highest(const Eigen::Matrix2Xd& positions, const Eigen::VectorXd& values) {
  QuadraticFit quadratic;
  for (Index k = 0; k < positions.cols(); ++k)
    quadratic.add(positions(0, k), positions(1, k), values[k]);
  const auto fit = quadratic.coefficients();
  Eigen::Matrix2d bend;
  bend << 2 * fit[3], fit[4], fit[4], 2 * fit[5];
  const SymmetricEigen<2> axes = eigen_of(bend);
  Eigen::Vector2d at = Eigen::Vector2d::Zero();
  for (int k = 0; k < 2; ++k) {
    const Eigen::Vector2d axis = axes.vectors.col(k);
    const double bent = axes.values[k], rise = axis.dot(fit.segment<2>(1));
    at += (bent < 0 ? std::clamp(-rise / bent, -1.0, 1.0) : std::copysign(1.0, rise)) * axis;
  }
  return at;
}

}  // namespace

SphereCandidate at_support_maximum(const SphereCandidate& candidate,
                                   const ParametricRefinement& refinement) {
  constexpr int side = 2 * few + 1;
  Eigen::Matrix2Xd positions(2, side * side);
  for (int k = 0; k < side * side; ++k)
    positions.col(k) = Eigen::Vector2d(k / side - few, k % side - few) / few;
  SphereCandidate best = candidate;
  for (const double step : rounds) {
    const Eigen::Matrix<double, 4, 2> around =
        few * step * refinement.spacing() * refinement.loosest(best.shape);
    Eigen::VectorXd values(positions.cols());
    for (Index k = 0; k < positions.cols(); ++k)
      values[k] = refinement.support(best.shape.changed(around * positions.col(k)), compared);
    best.shape = best.shape.changed(around * highest(positions, values));
    best = refinement.fitted(best, refitted, 3);
  }
  best.support = refinement.support(best.shape, look_again);
  return best.support > refinement.support(candidate.shape, look_again) ? best : candidate;
}

}  // namespace symsurf
