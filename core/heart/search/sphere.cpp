#include <symsurf/mirrors.h>

#include <algorithm>
#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "fit/partner_fit.h"
#include "search/auto.h"
#include "search/parametric.h"

namespace symsurf {

namespace {

struct SphereKind {
  using Shape = UnitSphere;
  static constexpr const char* name = "sphere";
  static constexpr double widest = 1e4;  // wider ones lose digits, and are planes to anybody

  static double radius(const UnitSphere& sphere) { return sphere.radius(); }

  // A pair fixes a point and the normal of the sphere there; the curvature is scanned.
  static constexpr auto through = [](const Vector3& middle, const Vector3& u, double most,
                                     const auto& add) {
    // Of both signs: to which side of the pair the centre lies. Diagonals.
    constexpr std::array curvatures{0.4, 0.8, 1.2, 1.6, 2.0, 2.5, 3.0,
                                    3.6, 4.3, 5.2, 6.5, 8.0, 10.0};
    add(UnitSphere{middle, u, 0});
    for (const double curvature : curvatures)
      if (curvature <= most)
        for (const double side : {-1.0, 1.0}) add(UnitSphere{middle, u, side * curvature});
  };

  SphereKind(const Cloud& cloud, const NearestPoints& points, const Refinement& refinement,
             const Context& context)
      : cloud_(cloud),
        refinement_(refinement),
        partner_fit_(cloud, points, cloud.tree(context), refinement.spacing(), context) {}

  SphereCandidate fitted(const SphereCandidate& start) const {
    return partner_fit_(refinement_.fitted(start, of_each));
  }

  SphereCandidate closely(SphereCandidate sphere) const {
    if (sphere.partnered == 0) return polished(sphere, of_best, refinement_);
    sphere.shape = partner_fit_.refined(sphere.shape, of_best.samples);
    return sphere;
  }

  // Takes out spheres that are nearly planes, where the plane that touches them next to the cloud's
  // middle, fitted in the same way, explains about as much: the best two that differ.
  static std::vector<SphereCandidate> taken_planes(const Surfels& surfels, const SurfelMap& map,
                                                   std::vector<SphereCandidate>& candidates) {
    constexpr double as_much = 0.9;
    const auto is_bent = [&](const SphereCandidate& c) {
      return c.shape.radius() < bent ||
             refined_on_surfels(surfels, map, Candidate<UnitPlane>{touching_plane(c.shape)}, 0.03,
                                0.02, 4, 1)
                     .support <= as_much * support_share(surfels, map, c.shape, 0.02);
    };
    const auto planes = std::stable_partition(candidates.begin(), candidates.end(), is_bent);
    std::vector<SphereCandidate> taken(planes, candidates.end());
    candidates.erase(planes, candidates.end());
    suppress_non_maxima(surfels, taken, alike_shapes, 2);
    return taken;
  }

  // Unless there is nothing else.
  void drop_planes(const MirrorScore& score, std::vector<SphereCandidate>& candidates) const {
    constexpr double gain = 0.99;  // a sphere has a number more
    std::vector<SphereCandidate> spheres = candidates;
    std::erase_if(spheres, [&](const SphereCandidate& c) {
      if (c.shape.radius() < bent) return false;
      const UnitPlane plane = refinement_.fitted(touching_plane(c.shape), of_each);
      return score.fit(in_input_units(plane, cloud_.frame)).share >=
             gain * score.fit(in_input_units(c.shape, cloud_.frame)).share;
    });
    if (!spheres.empty()) candidates = std::move(spheres);
  }

  // Much of a cloud without partners may have a sphere of its own: of two half balls.
  std::optional<Points> rest(const SphereCandidate& best) const {
    constexpr double worth_searching = 0.25;  // of the cloud
    if (best.partnered == 0) return std::nullopt;
    Points unpaired = partner_fit_.unpaired_points(best.shape);
    const auto least = worth_searching * static_cast<double>(cloud_.points.size());
    if (static_cast<double>(unpaired.rows()) < least) return std::nullopt;
    return unpaired;
  }

 private:
  static constexpr double bent = 0.6;  // diagonals: smaller spheres are no planes

  static UnitPlane touching_plane(const UnitSphere& sphere) {
    const Vector3 up = sphere.gradient(Vector3::Zero()).normalized();
    return {up, sphere.distance(Vector3::Zero())};
  }

  const Cloud& cloud_;
  const Refinement& refinement_;
  PartnerFit partner_fit_;
};

std::shared_ptr<Mirror> bent_sphere(const PlaneBend& bend, const Refinement& refinement,
                                    const PrincipalFrame& frame) {
  return mirror_of(refinement.fitted(bend.sphere(), of_best), frame);
}

}  // namespace

MethodImplementation sphere_method() {
  MethodImplementation method;
  method.name = "sphere";
  method.title = "Mirror sphere";
  method.summary =
      "Finds the sphere that mirrors the shape best, of any radius: candidates from pairs of "
      "points, refined on the full cloud.";
  method.parameters = {
      surfels_searched(700, "the sphere"),
      max_candidates(5, 7, "spheres"),
      pair_distance(),
  };
  method.minimum_points = 5;
  method.automatic = true;
  method.distance_from = distance_from_sphere;
  method.bent_from = bent_sphere;
  method.reports_unpaired_points = true;
  method.run = searched<SphereKind>;
  return method;
}

}  // namespace symsurf
