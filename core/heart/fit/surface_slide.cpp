#include "fit/surface_slide.h"

#include <algorithm>
#include <array>
#include <vector>

#include "fit/shapes.h"

namespace symsurf {

namespace {

// Mirrors over the plane of the two loosest changes of one: from one to the next, images move by
// half the spacing of the points.
template <typename Shape>
std::vector<Shape> shapes_around(const Shape& shape,
                                 const Eigen::Matrix<double, Eigen::Dynamic, 2>& loosest,
                                 double spacing) {
  constexpr double step = 0.5;          // of the spacing
  constexpr std::array farthest{7, 4};  // steps to either side, of the loosest and the next
  std::vector<Shape> around;
  for (int i = -farthest[0]; i <= farthest[0]; ++i)
    for (int j = -farthest[1]; j <= farthest[1]; ++j)
      around.push_back(shape.changed(step * spacing * loosest * Eigen::Vector2d(i, j)));
  return around;
}

template <typename Shape>
Candidate<Shape> slid_along_surfaces(Candidate<Shape> candidate, const Refinement& refinement) {
  constexpr int slides = 4;
  constexpr Index first_samples = 120, second_samples = 800;
  constexpr std::size_t tried_slides = 4;
  constexpr double clearly_more = 1e-3;
  candidate.support = refinement.support(candidate.shape, second_samples);
  for (int slide = 0; slide < slides; ++slide) {
    std::vector<Candidate<Shape>> positions;
    for (const Shape& shape :
         shapes_around(candidate.shape, refinement.loosest(candidate.shape), refinement.spacing()))
      positions.push_back({shape, refinement.support(shape, first_samples)});
    sort_best_first(positions);
    positions.resize(std::min(tried_slides, positions.size()));
    const double before = candidate.support;
    for (const Candidate<Shape>& position : positions) {
      const Candidate<Shape> fitted =
          refinement.fitted(position, {.samples = second_samples, .steps = 6});
      if (fitted.support > candidate.support + clearly_more) candidate = fitted;
    }
    if (candidate.support == before) break;
  }
  return candidate;
}

}  // namespace

template <typename Shape>
Candidate<Shape> polished(const Candidate<Shape>& candidate, const Fit& fit,
                          const Refinement& refinement) {
  Candidate<Shape> close = refinement.fitted(slid_along_surfaces(candidate, refinement), fit);
  close.shape = refinement.exact(close.shape);
  close.support = refinement.support(close.shape, fit.samples);
  return close;
}

template Candidate<UnitSphere> polished(const Candidate<UnitSphere>&, const Fit&,
                                        const Refinement&);
template Candidate<UnitCylinder> polished(const Candidate<UnitCylinder>&, const Fit&,
                                          const Refinement&);

}  // namespace symsurf
