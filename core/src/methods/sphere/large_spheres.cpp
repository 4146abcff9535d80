#include "methods/sphere/large_spheres.h"

#include <cmath>
#include <iterator>

#include "cloud/unit_plane.h"

namespace symsurf {

namespace {

constexpr double bent = 0.6;    // diagonals: smaller spheres are no planes
constexpr double widest = 1e4;  // diagonals: larger ones lose digits, and are planes to anybody
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
  std::erase_if(candidates, [](const SphereCandidate& c) { return c.shape.radius() > widest; });
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
