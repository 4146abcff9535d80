#include "methods/sphere/surface_slide.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/quadratic_fit.h"
#include "base/symmetric_eigen.h"

namespace symsurf {

namespace {

constexpr double step = 0.5;          // of the spacing
constexpr std::array farthest{7, 4};  // steps to either side, of the loosest and the next

constexpr int slides = 4;
constexpr Index first_samples = 120, second_samples = 800;  // samples
constexpr std::size_t tried_slides = 4;
constexpr double clearly_more = 1e-3;

constexpr std::array rounds{1.0, 0.6};                               // their steps, in spacings
constexpr int few = 2;                                               // steps to either side
constexpr Index settling = 1200, refitted = 800, look_again = 3000;  // samples

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

std::vector<UnitSphere> spheres_around(const UnitSphere& sphere,
                                       const Eigen::Matrix<double, 4, 2>& loosest, double spacing) {
  std::vector<UnitSphere> around;
  for (int i = -farthest[0]; i <= farthest[0]; ++i)
    for (int j = -farthest[1]; j <= farthest[1]; ++j) {
      const Eigen::Vector4d by = step * spacing * loosest * Eigen::Vector2d(i, j);
      around.push_back(sphere.changed(by));
    }
  return around;
}

SphereCandidate slid_along_surfaces(SphereCandidate candidate,
                                    const ParametricRefinement& refinement) {
  candidate.support = refinement.support(candidate.shape, second_samples);
  for (int slide = 0; slide < slides; ++slide) {
    std::vector<SphereCandidate> positions;
    for (const UnitSphere& sphere :
         spheres_around(candidate.shape, refinement.loosest(candidate.shape), refinement.spacing()))
      positions.push_back({sphere, refinement.support(sphere, first_samples)});
    sort_best_first(positions);
    positions.resize(std::min(tried_slides, positions.size()));
    const double before = candidate.support;
    for (const SphereCandidate& position : positions) {
      const SphereCandidate fitted = refinement.fitted(position, second_samples, 6);
      if (fitted.support > candidate.support + clearly_more) candidate = fitted;
    }
    if (candidate.support == before) break;
  }
  return candidate;
}

SphereCandidate settled_on_surfaces(const SphereCandidate& candidate,
                                    const ParametricRefinement& refinement) {
  constexpr int side = 2 * few + 1;
  Eigen::Matrix2Xd positions(2, side * side);
  for (int k = 0; k < side * side; ++k)
    positions.col(k) = Eigen::Vector2d(k / side - few, k % side - few) / few;
  SphereCandidate settled = candidate;
  for (const double step : rounds) {
    const Eigen::Matrix<double, 4, 2> around =
        few * step * refinement.spacing() * refinement.loosest(settled.shape);
    Eigen::VectorXd values(positions.cols());
    for (Index k = 0; k < positions.cols(); ++k)
      values[k] = refinement.support(settled.shape.changed(around * positions.col(k)), settling);
    settled.shape = settled.shape.changed(around * highest(positions, values));
    settled = refinement.fitted(settled, refitted, 3);
  }
  settled.support = refinement.support(settled.shape, look_again);
  return settled.support > refinement.support(candidate.shape, look_again) ? settled : candidate;
}

}  // namespace symsurf
