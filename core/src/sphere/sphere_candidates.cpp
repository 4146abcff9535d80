#include "sphere_candidates.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "../plane/agreement.h"
#include "../random.h"

namespace symsurf {

namespace {

constexpr Index pairs_tried = 40000, pairs_kept = 4000;
constexpr double shortest_chord = 0.05;
constexpr double facing_cosine = 0.88;                           // 28 degrees
constexpr Index glance = 8, first_look = 24, second_look = 120;  // surfels a candidate is tried on
constexpr double search_tolerance = 0.03;
constexpr double least_explained = 0.15;
constexpr std::size_t first_count = 1500, second_count = 300;
constexpr double least_moved = 0.35;

// Of both signs: to which side of the pair the centre lies. Diagonals.
constexpr std::array curvatures{0.4, 0.8, 1.2, 1.6, 2.0, 2.5, 3.0, 3.6, 4.3, 5.2, 6.5, 8.0, 10.0};

void sort_best_first(std::vector<SphereCandidate>& candidates) {
  std::stable_sort(
      candidates.begin(), candidates.end(),
      [](const SphereCandidate& a, const SphereCandidate& b) { return a.explained > b.explained; });
}

// Two mirrors act alike where they send points to like places.
double difference(const Surfels& surfels, const UnitSphere& a, const UnitSphere& b) {
  constexpr Index probes = 12;
  constexpr double apart = 0.5;  // where only one has an image
  double squared = 0;
  for (Index k = 0; k < probes; ++k) {
    const Vector3& x = surfels[k * surfels.size() / probes].position;
    const Vector3 gap = a.reflect(x) - b.reflect(x);
    squared += gap.allFinite()
                   ? std::min(gap.squaredNorm(), apart * apart)
                   : (a.reflect(x).allFinite() == b.reflect(x).allFinite() ? 0 : apart * apart);
  }
  return std::sqrt(squared / static_cast<double>(probes));
}

std::vector<UnitSphere> spheres_of_pairs(const Surfels& surfels, std::uint64_t seed) {
  Random random(seed);
  std::vector<UnitSphere> spheres;
  Index kept = 0;
  for (Index trial = 0; trial < pairs_tried && kept < pairs_kept; ++trial) {
    const Surfel& a = surfels[random.below(surfels.size())];
    const Surfel& b = surfels[random.below(surfels.size())];
    const Vector3 chord = b.position - a.position;
    const double length = chord.norm();
    if (length < shortest_chord) continue;
    const Vector3 u = chord / length, middle = (a.position + b.position) / 2;
    bool faced = false;
    for (const double curvature : curvatures)
      for (const double side : {-1.0, 1.0}) {
        const UnitSphere sphere{middle + side / curvature * u, 1 / curvature};
        if (length > 1.9 * sphere.radius) continue;
        const double cosine = sphere.reflect_direction(a.position, a.normal).dot(b.normal);
        if (std::abs(cosine) < facing_cosine && a.flatness * b.flatness > 0.25) continue;
        spheres.push_back(sphere);
        faced = true;
      }
    kept += faced;
  }
  return spheres;
}

}  // namespace

double explained_share(const Surfels& surfels, const SurfelMap& map, const UnitSphere& sphere,
                       double tolerance, Index stride) {
  double moved = 0, explained = 0;
  Index looked = 0;
  for (Index i = 0; i < surfels.size(); i += stride, ++looked) {
    const Surfel& s = surfels[i];
    const double weight = displaced(sphere.distance(s.position), tolerance);
    if (weight <= 0) continue;
    moved += weight;
    const Vector3 image = sphere.reflect(s.position);
    const Index j = map.nearest(image);
    if (j < 0) continue;
    const Agreement agreement(image - surfels[j].position,
                              sphere.reflect_direction(s.position, s.normal), s.flatness,
                              surfels[j]);
    explained += weight * agreement.weight(tolerance);
  }
  return explained / std::max(moved, least_moved * static_cast<double>(looked));
}

std::vector<SphereCandidate> candidate_spheres(const Surfels& surfels, const SurfelMap& map,
                                               std::uint64_t seed, Index count) {
  const auto stride = [&](Index wanted) { return std::max<Index>(1, surfels.size() / wanted); };
  std::vector<SphereCandidate> found;
  for (const UnitSphere& sphere : spheres_of_pairs(surfels, seed)) {
    if (explained_share(surfels, map, sphere, search_tolerance, stride(glance)) < least_explained)
      continue;
    const double explained =
        explained_share(surfels, map, sphere, search_tolerance, stride(first_look));
    if (explained > least_explained) found.push_back({sphere, explained});
  }
  sort_best_first(found);
  found.resize(std::min(found.size(), first_count));
  keep_distinct(surfels, found, 0.04, second_count);
  for (SphereCandidate& candidate : found)
    candidate.explained =
        explained_share(surfels, map, candidate.sphere, search_tolerance, stride(second_look));
  keep_distinct(surfels, found, 0.06, count);
  return found;
}

SphereCandidate settled(const Surfels& surfels, const SurfelMap& map, SphereCandidate candidate,
                        double widest, double narrowest, int steps, Index stride) {
  for (int step = 0; step < steps; ++step) {
    const double tolerance = widest * std::pow(narrowest / widest, step / (steps - 1.0));
    SphereStep sum(candidate.sphere);
    for (Index i = 0; i < surfels.size(); i += stride) {
      const Surfel& s = surfels[i];
      const double weight = displaced(candidate.sphere.distance(s.position), tolerance);
      if (weight <= 0) continue;
      const Vector3 image = candidate.sphere.reflect(s.position);
      const Index j = map.nearest(image);
      if (j < 0) continue;
      const Vector3 gap = image - surfels[j].position;
      const Agreement agreement(gap, candidate.sphere.reflect_direction(s.position, s.normal),
                                s.flatness, surfels[j]);
      sum.add(s.position, gap, agreement.metric(), weight * agreement.weight(tolerance));
    }
    candidate.sphere = sum.taken();
  }
  candidate.explained = explained_share(surfels, map, candidate.sphere, narrowest, stride);
  return candidate;
}

void keep_distinct(const Surfels& surfels, std::vector<SphereCandidate>& candidates,
                   double distance, Index count) {
  sort_best_first(candidates);
  std::vector<SphereCandidate> kept;
  for (const SphereCandidate& candidate : candidates) {
    if (static_cast<Index>(kept.size()) == count) break;
    const bool is_new = std::none_of(kept.begin(), kept.end(), [&](const SphereCandidate& other) {
      return difference(surfels, other.sphere, candidate.sphere) < distance;
    });
    if (is_new) kept.push_back(candidate);
  }
  candidates = std::move(kept);
}

}  // namespace symsurf
