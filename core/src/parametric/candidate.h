#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "settling.h"

namespace symsurf {

// What the searches for mirrors of few numbers share. A `Shape` is such a mirror in the principal
// frame: distance(x), reflect(x) (NaN without an image), reflect_direction(x, n), the unit normal
// at the image of a sheet through x with normal n, and Shape::Step, one Gauss-Newton step.

/// A mirror, the share of the surfels that it explains and that of the points that it maps onto
/// partners of their own, beyond chance; both in [0, 1].
template <typename Shape>
struct Candidate {
  Shape shape;
  double explained = 0;
  double partnered = 0;

  /// Many mirrors explain a plain sheet, but only the true one partners its points.
  double merit() const { return explained + partnered; }
};

template <typename Shape>
void sort_best_first(std::vector<Candidate<Shape>>& candidates) {
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const auto& a, const auto& b) { return a.merit() > b.merit(); });
}

/// Share of the surfels whose images agree with the cloud, out of those the mirror moves (at least
/// 35 % of all, so that a mirror the cloud lies along explains nothing). Surfels without an image
/// count as moved. `stride` k looks at every k-th surfel.
template <typename Shape>
double explained_share(const Surfels& surfels, const SurfelMap& map, const Shape& shape,
                       double tolerance, Index stride = 1) {
  constexpr double least_moved = 0.35;
  double moved = 0, explained = 0;
  Index looked = 0;
  for (Index i = 0; i < surfels.size(); i += stride, ++looked) {
    const Surfel& s = surfels[i];
    const double weight = displaced(shape.distance(s.position), tolerance);
    if (weight <= 0) continue;
    moved += weight;
    const Vector3 image = shape.reflect(s.position);
    const Index j = map.nearest(image);
    if (j < 0) continue;
    const Agreement agreement(image - surfels[j].position,
                              shape.reflect_direction(s.position, s.normal), s.flatness,
                              surfels[j]);
    explained += weight * agreement.weight(tolerance);
  }
  return explained / std::max(moved, least_moved * static_cast<double>(looked));
}

/// Moves a mirror onto the surfels' images.
template <typename Shape>
Candidate<Shape> settled(const Surfels& surfels, const SurfelMap& map, Candidate<Shape> candidate,
                         double widest, double narrowest, int steps, Index stride) {
  candidate.shape =
      moved_onto_images(surfels, map, candidate.shape, widest, narrowest, steps, stride);
  candidate.explained = explained_share(surfels, map, candidate.shape, narrowest, stride);
  return candidate;
}

/// Where a mirror sends a few places of the cloud: mirrors act alike where they send them to like
/// places.
struct Action {
  static constexpr Index probes = 12;

  std::array<Vector3, probes> images;

  template <typename Shape>
  Action(const Surfels& surfels, const Shape& shape) {
    for (Index k = 0; k < probes; ++k)
      images[k] = shape.reflect(surfels[k * surfels.size() / probes].position);
  }

  /// Root mean square, in diagonals.
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

/// Drops mirrors that act on the cloud nearly as a better one does; best first.
template <typename Shape>
void keep_distinct(const Surfels& surfels, std::vector<Candidate<Shape>>& candidates,
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

/// The best `count` of many hypotheses that differ: each meets a glance at few surfels first.
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
    if (explained_share(surfels, map, shape, tolerance, stride(glance)) < least_explained) continue;
    const double explained = explained_share(surfels, map, shape, tolerance, stride(first_look));
    if (explained > least_explained) found.push_back({shape, explained});
  }
  sort_best_first(found);
  found.resize(std::min(found.size(), first_count));
  keep_distinct(surfels, found, 0.04, second_count);
  for (Candidate<Shape>& candidate : found) {
    context.check();
    candidate.explained =
        explained_share(surfels, map, candidate.shape, tolerance, stride(second_look));
  }
  keep_distinct(surfels, found, 0.06, count);
  return found;
}

}  // namespace symsurf
