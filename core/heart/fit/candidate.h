#pragma once

#include <symsurf/context.h>

#include <algorithm>
#include <array>
#include <vector>

#include "cloud/surfels.h"

namespace symsurf {

// What the searches for mirrors of few numbers share. A `Shape` is such a mirror in the principal
// frame: distance(x), reflect(x) (NaN without an image), reflect_direction(x, n), the unit normal
// at the image of a surface through x with normal n, and Shape::Step, one Gauss-Newton step.
// Compiled for the shapes of shapes.h.

/// A mirror, the share of the surfels that it explains and that of the points that it maps onto
/// partners of their own, beyond chance; both in [0, 1].
template <typename Shape>
struct Candidate {
  Shape shape;
  double support = 0;
  double partnered = 0;

  /// Many mirrors explain a plain surface, but only the true one partners its points.
  double merit() const { return support + partnered; }
};

template <typename Shape>
void sort_best_first(std::vector<Candidate<Shape>>& candidates) {
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const auto& a, const auto& b) { return a.merit() > b.merit(); });
}

/// Share of the surfels whose images agree with the cloud, less `contradiction` times those whose
/// images come beside it, out of those the mirror moves (at least 35 % of all, so that a mirror the
/// cloud lies along explains nothing). Surfels without an image count as moved; an image in the
/// void says nothing: that part may be missing. `stride` k looks at every k-th surfel.
template <typename Shape>
double support_share(const Surfels& surfels, const SurfelMap& map, const Shape& shape,
                     double tolerance, Index stride = 1, double contradiction = 0);

/// Moves a mirror onto the surfels' images, looking less far with each step.
template <typename Shape>
Candidate<Shape> refined_on_surfels(const Surfels& surfels, const SurfelMap& map,
                                    Candidate<Shape> candidate, double widest, double narrowest,
                                    int steps, Index stride, double contradiction = 0);

/// Drops mirrors that send the probes nearly where a better one does, within `distance` diagonals,
/// root mean square; best first.
template <typename Shape>
void suppress_non_maxima(const std::vector<Vector3>& probes,
                         std::vector<Candidate<Shape>>& candidates, double distance, Index count);

/// The same with positions of the cloud for probes.
template <typename Shape>
void suppress_non_maxima(const Surfels& surfels, std::vector<Candidate<Shape>>& candidates,
                         double distance, Index count);

/// The best `count` of many hypotheses that differ: each meets a glance at few surfels first.
template <typename Shape>
std::vector<Candidate<Shape>> best_of(const std::vector<Shape>& hypotheses, const Surfels& surfels,
                                      const SurfelMap& map, Index count, const Context& context);

/// The same of large, middling and small mirrors apart, by `radius(shape)`, in diagonals: of balls
/// and tubes any plane through the middle, and what is nearly one, explains more than small mirrors
/// beside the true one do.
template <typename Shape, typename Radius>
std::vector<Candidate<Shape>> best_of_each_size(std::vector<Shape> hypotheses, const Radius& radius,
                                                const Surfels& surfels, const SurfelMap& map,
                                                Index count, const Context& context) {
  constexpr std::array least_radii{0.7, 0.3, 0.0};
  std::vector<Candidate<Shape>> candidates;
  for (const double least : least_radii) {
    const auto rest =
        std::stable_partition(hypotheses.begin(), hypotheses.end(),
                              [&](const Shape& shape) { return radius(shape) < least; });
    const std::vector<Shape> chosen(rest, hypotheses.end());
    hypotheses.erase(rest, hypotheses.end());
    for (const Candidate<Shape>& candidate :
         best_of(chosen, surfels, map, count / static_cast<Index>(least_radii.size()), context))
      candidates.push_back(candidate);
  }
  return candidates;
}

}  // namespace symsurf
