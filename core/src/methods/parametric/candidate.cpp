#include "methods/parametric/candidate.h"

#include <array>
#include <cmath>

#include "methods/parametric/shapes.h"
#include "methods/parametric/surfel_icp.h"

namespace symsurf {

namespace {

// Where a mirror sends a few positions of the cloud: mirrors act alike where they send them to like
// positions.
struct Action {
  static constexpr Index probes = 12;

  std::array<Vector3, probes> images;

  template <typename Shape>
  Action(const Surfels& surfels, const Shape& shape) {
    for (Index k = 0; k < probes; ++k)
      images[k] = shape.reflect(surfels[k * surfels.size() / probes].position);
  }

  // Root mean square, in diagonals.
  double difference(const Action& other) const {
    constexpr double apart = 0.5;  // where only one has an image
    double squared = 0;
    for (Index k = 0; k < probes; ++k) {
      const double gap = (images[k] - other.images[k]).squaredNorm();
      const bool both = std::isfinite(gap);
      squared += both ? std::min(gap, apart * apart)
                      : (images[k].allFinite() == other.images[k].allFinite() ? 0 : apart * apart);
    }
    return std::sqrt(squared / static_cast<double>(probes));
  }
};

}  // namespace

template <typename Shape>
double support_share(const Surfels& surfels, const SurfelMap& map, const Shape& shape,
                     double tolerance, Index stride) {
  return agreeing_share(surfels, map, shape, tolerance, stride, 0);
}

template <typename Shape>
Candidate<Shape> refined_on_surfels(const Surfels& surfels, const SurfelMap& map,
                                    Candidate<Shape> candidate, double widest, double narrowest,
                                    int steps, Index stride) {
  candidate.shape = icp_steps(surfels, map, candidate.shape, widest, narrowest, steps, stride);
  candidate.support = support_share(surfels, map, candidate.shape, narrowest, stride);
  return candidate;
}

template <typename Shape>
void suppress_non_maxima(const Surfels& surfels, std::vector<Candidate<Shape>>& candidates,
                         double distance, Index count) {
  sort_best_first(candidates);
  std::vector<Candidate<Shape>> kept;
  std::vector<Action> actions;
  for (const Candidate<Shape>& candidate : candidates) {
    if (static_cast<Index>(kept.size()) == count) break;
    const Action action(surfels, candidate.shape);
    const bool is_new = std::none_of(actions.begin(), actions.end(), [&](const Action& other) {
      return other.difference(action) < distance;
    });
    if (!is_new) continue;
    kept.push_back(candidate);
    actions.push_back(action);
  }
  candidates = std::move(kept);
}

template <typename Shape>
std::vector<Candidate<Shape>> best_of(const std::vector<Shape>& hypotheses, const Surfels& surfels,
                                      const SurfelMap& map, Index count, const Context& context) {
  constexpr Index glance = 8, first_look = 24, second_look = 120;  // surfels tried on
  constexpr double tolerance = 0.03, least_explained = 0.15;
  constexpr std::size_t first_count = 1500, second_count = 300;
  const auto stride = [&](Index wanted) { return std::max<Index>(1, surfels.size() / wanted); };
  std::vector<Candidate<Shape>> found;
  for (std::size_t i = 0; i < hypotheses.size(); ++i) {
    if (i % 256 == 0) context.check();
    const Shape& shape = hypotheses[i];
    if (support_share(surfels, map, shape, tolerance, stride(glance)) < least_explained) continue;
    const double support = support_share(surfels, map, shape, tolerance, stride(first_look));
    if (support > least_explained) found.push_back({shape, support});
  }
  sort_best_first(found);
  found.resize(std::min(found.size(), first_count));
  suppress_non_maxima(surfels, found, 0.04, second_count);
  for (Candidate<Shape>& candidate : found) {
    context.check();
    candidate.support =
        support_share(surfels, map, candidate.shape, tolerance, stride(second_look));
  }
  suppress_non_maxima(surfels, found, 0.06, count);
  return found;
}

template double support_share(const Surfels&, const SurfelMap&, const UnitSphere&, double, Index);

template Candidate<UnitPlane> refined_on_surfels(const Surfels&, const SurfelMap&,
                                                 Candidate<UnitPlane>, double, double, int, Index);
template Candidate<UnitSphere> refined_on_surfels(const Surfels&, const SurfelMap&,
                                                  Candidate<UnitSphere>, double, double, int,
                                                  Index);
template Candidate<UnitCylinder> refined_on_surfels(const Surfels&, const SurfelMap&,
                                                    Candidate<UnitCylinder>, double, double, int,
                                                    Index);

template void suppress_non_maxima(const Surfels&, std::vector<Candidate<UnitSphere>>&, double,
                                  Index);
template void suppress_non_maxima(const Surfels&, std::vector<Candidate<UnitCylinder>>&, double,
                                  Index);

template std::vector<Candidate<UnitSphere>> best_of(const std::vector<UnitSphere>&, const Surfels&,
                                                    const SurfelMap&, Index, const Context&);
template std::vector<Candidate<UnitCylinder>> best_of(const std::vector<UnitCylinder>&,
                                                      const Surfels&, const SurfelMap&, Index,
                                                      const Context&);

}  // namespace symsurf
