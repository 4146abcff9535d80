#include "sheet_slide.h"

#include <algorithm>
#include <array>

namespace symsurf {

namespace {

constexpr double step = 0.5;          // of the spacing
constexpr std::array farthest{7, 4};  // steps to either side, of the loosest and the next

constexpr int slides = 4;
constexpr Index glance = 120, look = 800;  // samples
constexpr std::size_t attempts = 4;
constexpr double clearly_more = 1e-3;

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

SphereCandidate slid_along_sheets(SphereCandidate candidate,
                                  const ParametricRefinement& refinement) {
  candidate.explained = refinement.explained(candidate.shape, look);
  for (int slide = 0; slide < slides; ++slide) {
    std::vector<SphereCandidate> places;
    for (const UnitSphere& sphere :
         spheres_around(candidate.shape, refinement.loosest(candidate.shape), refinement.spacing()))
      places.push_back({sphere, refinement.explained(sphere, glance)});
    sort_best_first(places);
    places.resize(std::min(attempts, places.size()));
    const double before = candidate.explained;
    for (const SphereCandidate& place : places) {
      const SphereCandidate fitted = refinement.fitted(place, look, 6);
      if (fitted.explained > candidate.explained + clearly_more) candidate = fitted;
    }
    if (candidate.explained == before) break;
  }
  return candidate;
}

}  // namespace symsurf
