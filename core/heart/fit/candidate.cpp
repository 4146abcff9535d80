#include "fit/candidate.h"

#include <array>
#include <cmath>

#include "base/math.h"
#include "base/parallel.h"
#include "fit/shapes.h"
#include "pairing/correspondence.h"

namespace symsurf {

namespace {

// Mirrors act alike where they send a few positions to like positions.
struct Action {
  std::vector<Vector3> images;

  template <typename Shape>
  Action(const std::vector<Vector3>& probes, const Shape& shape) {
    for (const Vector3& x : probes) images.push_back(shape.reflect(x));
  }

  // Root mean square, in diagonals.
  double difference(const Action& other) const {
    constexpr double apart = 0.5;  // where only one has an image
    double squared = 0;
    for (std::size_t k = 0; k < images.size(); ++k) {
      const double gap = (images[k] - other.images[k]).squaredNorm();
      const bool both = std::isfinite(gap);
      squared += both ? std::min(gap, apart * apart)
                      : (images[k].allFinite() == other.images[k].allFinite() ? 0 : apart * apart);
    }
    return std::sqrt(squared / static_cast<double>(images.size()));
  }
};

}  // namespace

template <typename Shape>
Candidate<Shape> refined_on_surfels(const Surfels& surfels, const SurfelMap& map,
                                    Candidate<Shape> candidate, double widest, double narrowest,
                                    int steps, Index stride, double contradiction) {
  const PatchMatcher patches(surfels, map, stride);
  candidate.shape = fitted(candidate.shape, patches, {widest, narrowest, steps}, patches.kernel());
  candidate.support =
      support_share(surfels, map, candidate.shape, narrowest, stride, contradiction);
  return candidate;
}

template <typename Shape>
void suppress_non_maxima(const std::vector<Vector3>& probes,
                         std::vector<Candidate<Shape>>& candidates, double distance, Index count) {
  sort_best_first(candidates);
  std::vector<Candidate<Shape>> kept;
  std::vector<Action> actions;
  for (const Candidate<Shape>& candidate : candidates) {
    if (static_cast<Index>(kept.size()) == count) break;
    const Action action(probes, candidate.shape);
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
void suppress_non_maxima(const Surfels& surfels, std::vector<Candidate<Shape>>& candidates,
                         double distance, Index count) {
  constexpr Index probes = 12;
  std::vector<Vector3> positions;
  for (Index k = 0; k < probes; ++k)
    positions.push_back(surfels[k * surfels.size() / probes].position);
  suppress_non_maxima(positions, candidates, distance, count);
}

template <typename Shape>
std::vector<Candidate<Shape>> best_of(const std::vector<Shape>& hypotheses, const Surfels& surfels,
                                      const SurfelMap& map, Index count, const Context& context) {
  constexpr Index grain = 32;  // mirrors that a thread takes at a time
  constexpr Index glance = 8, first_look = 24, second_look = 120;  // surfels tried on
  constexpr double tolerance = 0.03, least_explained = 0.15;
  constexpr std::size_t first_count = 1500, second_count = 300;
  const auto stride = [&](Index wanted) { return std::max<Index>(1, surfels.size() / wanted); };
  std::vector<Candidate<Shape>> found;
  std::vector<double> supports(hypotheses.size());
  silent_parallel_for(
      context, static_cast<Index>(hypotheses.size()), grain, [&](Index begin, Index end) {
        for (Index i = begin; i < end; ++i) {
          supports[i] = support_share(surfels, map, hypotheses[i], tolerance, stride(glance));
          if (supports[i] >= least_explained)
            supports[i] = support_share(surfels, map, hypotheses[i], tolerance, stride(first_look));
        }
      });
  for (std::size_t i = 0; i < hypotheses.size(); ++i)
    if (supports[i] > least_explained) found.push_back({hypotheses[i], supports[i]});
  sort_best_first(found);
  found.resize(std::min(found.size(), first_count));
  suppress_non_maxima(surfels, found, 0.04, second_count);
  silent_parallel_for(
      context, static_cast<Index>(found.size()), grain, [&](Index begin, Index end) {
        for (Index i = begin; i < end; ++i)
          found[i].support =
              support_share(surfels, map, found[i].shape, tolerance, stride(second_look));
      });
  suppress_non_maxima(surfels, found, 0.06, count);
  return found;
}

template Candidate<UnitPlane> refined_on_surfels(const Surfels&, const SurfelMap&,
                                                 Candidate<UnitPlane>, double, double, int, Index,
                                                 double);
template Candidate<UnitSphere> refined_on_surfels(const Surfels&, const SurfelMap&,
                                                  Candidate<UnitSphere>, double, double, int, Index,
                                                  double);
template Candidate<UnitCylinder> refined_on_surfels(const Surfels&, const SurfelMap&,
                                                    Candidate<UnitCylinder>, double, double, int,
                                                    Index, double);
template Candidate<UnitPlacement> refined_on_surfels(const Surfels&, const SurfelMap&,
                                                     Candidate<UnitPlacement>, double, double, int,
                                                     Index, double);

template void suppress_non_maxima(const std::vector<Vector3>&, std::vector<Candidate<UnitPlane>>&,
                                  double, Index);
template void suppress_non_maxima(const std::vector<Vector3>&,
                                  std::vector<Candidate<UnitObliquePlane>>&, double, Index);
template void suppress_non_maxima(const Surfels&, std::vector<Candidate<UnitSphere>>&, double,
                                  Index);
template void suppress_non_maxima(const Surfels&, std::vector<Candidate<UnitCylinder>>&, double,
                                  Index);
template void suppress_non_maxima(const Surfels&, std::vector<Candidate<UnitPlacement>>&, double,
                                  Index);

template std::vector<Candidate<UnitSphere>> best_of(const std::vector<UnitSphere>&, const Surfels&,
                                                    const SurfelMap&, Index, const Context&);
template std::vector<Candidate<UnitCylinder>> best_of(const std::vector<UnitCylinder>&,
                                                      const Surfels&, const SurfelMap&, Index,
                                                      const Context&);
template std::vector<Candidate<UnitPlacement>> best_of(const std::vector<UnitPlacement>&,
                                                       const Surfels&, const SurfelMap&, Index,
                                                       const Context&);

}  // namespace symsurf
