#include "search/sphere_candidates.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "cloud/principal_frame.h"
#include "fit/hypotheses.h"

namespace symsurf {

namespace {

constexpr Index sphere_pairs_tried = 40000, sphere_pairs_kept = 4000;

// Of both signs: to which side of the pair the centre lies. Diagonals.
constexpr std::array sphere_curvatures{0.4, 0.8, 1.2, 1.6, 2.0, 2.5, 3.0,
                                       3.6, 4.3, 5.2, 6.5, 8.0, 10.0};

constexpr Index started_spheres = 48;         // candidates that are refined on the surfels
constexpr double least_sphere_support = 0.6;  // of the best; others are not fitted

// Spheres that mirror a pair of surfels onto each other, normals included. A pair fixes a point and
// the normal of the sphere there; the curvature is scanned. The best `count` that differ.
std::vector<SphereCandidate> candidate_spheres(const Surfels& surfels, const SurfelMap& map,
                                               std::uint64_t seed, Index count,
                                               const Context& context) {
  const auto through = [](const Vector3& middle, const Vector3& u, double most, const auto& add) {
    add(UnitSphere{middle, u, 0});
    for (const double curvature : sphere_curvatures)
      if (curvature <= most)
        for (const double side : {-1.0, 1.0}) add(UnitSphere{middle, u, side * curvature});
  };
  return best_of_each_size(
      hypotheses_of_pairs<UnitSphere>(surfels, seed, sphere_pairs_tried, sphere_pairs_kept, through,
                                      context),
      [](const UnitSphere& sphere) { return sphere.radius(); }, surfels, map, count, context);
}

void drop_weakly_supported(std::vector<SphereCandidate>& candidates) {
  const double least = least_sphere_support * candidates.front().support;
  std::erase_if(candidates, [&](const SphereCandidate& c) { return c.support < least; });
}

}  // namespace

std::vector<SphereCandidate> promising_spheres(const Surfels& surfels, const SurfelMap& map,
                                               std::uint64_t seed, Index count,
                                               const Context& context) {
  std::vector<SphereCandidate> candidates =
      candidate_spheres(surfels, map, seed, started_spheres, context);
  if (candidates.empty()) candidates.push_back({});
  for (SphereCandidate& candidate : candidates) {
    context.check();
    candidate = refined_on_surfels(surfels, map, candidate, 0.04, 0.02, 4, 3);
  }
  std::vector<SphereCandidate> planes = take_planes(surfels, map, candidates);
  if (!candidates.empty()) {
    suppress_non_maxima(surfels, candidates, alike_spheres, started_spheres);
    drop_weakly_supported(candidates);
  }
  for (SphereCandidate& candidate : candidates) {
    context.check();
    candidate = refined_on_surfels(surfels, map, candidate, 0.02, 0.012, 4, 1);
  }
  suppress_non_maxima(surfels, candidates, alike_spheres, count);
  candidates.insert(candidates.end(), planes.begin(), planes.end());
  return candidates;
}

namespace {

constexpr double bent = 0.6;  // diagonals: smaller spheres are no planes
constexpr double widest_sphere =
    1e4;  // diagonals: larger ones lose digits, and are planes to anybody
constexpr double as_much = 0.9;
constexpr Index looked_at = 800;  // points
constexpr Index taken_at_most = 2;

bool could_be_plane(const UnitSphere& sphere) { return std::abs(sphere.curvature) * bent < 1; }

Candidate<UnitPlane> touching_plane(const UnitSphere& sphere) {
  const Vector3 up = sphere.gradient(Vector3::Zero()).normalized();
  return {{up, sphere.distance(Vector3::Zero())}};
}

Candidate<UnitPlane> fitted_plane(const Refinement& refinement, const UnitSphere& sphere) {
  return refinement.fitted(touching_plane(sphere), {.samples = looked_at, .steps = 6});
}

template <typename IsPlane>
void drop(const IsPlane& is_plane, std::vector<SphereCandidate>& candidates) {
  std::erase_if(candidates,
                [](const SphereCandidate& c) { return c.shape.radius() > widest_sphere; });
  std::vector<SphereCandidate> spheres;
  std::remove_copy_if(
      candidates.begin(), candidates.end(), std::back_inserter(spheres),
      [&](const SphereCandidate& c) { return could_be_plane(c.shape) && is_plane(c); });
  if (!spheres.empty()) candidates = std::move(spheres);
}

}  // namespace

std::vector<SphereCandidate> take_planes(const Surfels& surfels, const SurfelMap& map,
                                         std::vector<SphereCandidate>& candidates) {
  const auto planes =
      std::stable_partition(candidates.begin(), candidates.end(), [&](const SphereCandidate& c) {
        if (!could_be_plane(c.shape)) return true;
        const double flat =
            refined_on_surfels(surfels, map, touching_plane(c.shape), 0.03, 0.02, 4, 1).support;
        return flat <= as_much * support_share(surfels, map, c.shape, 0.02);
      });
  std::vector<SphereCandidate> taken(planes, candidates.end());
  candidates.erase(planes, candidates.end());
  suppress_non_maxima(surfels, taken, alike_spheres, taken_at_most);
  return taken;
}

void drop_planes(const Refinement& refinement, std::vector<SphereCandidate>& candidates) {
  drop(
      [&](const SphereCandidate& c) {
        return c.partnered == 0 && fitted_plane(refinement, c.shape).support >
                                       as_much * refinement.support(c.shape, looked_at);
      },
      candidates);
}

void drop_planes(const Refinement& refinement, const MirrorScore& score,
                 const PrincipalFrame& frame, std::vector<SphereCandidate>& candidates) {
  drop(
      [&](const SphereCandidate& c) {
        const Plane plane = in_input_units(fitted_plane(refinement, c.shape).shape, frame);
        const Sphere sphere = in_input_units(c.shape, frame);
        return merit(score.fit(plane), "plane") >= merit(score.fit(sphere), "sphere");
      },
      candidates);
}

}  // namespace symsurf
