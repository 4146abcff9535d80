#include <symsurf/mirrors.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "cloud/principal_frame.h"
#include "fit/candidate.h"
#include "fit/partner_fit.h"
#include "fit/refinement.h"
#include "pairing/matching.h"
#include "score/mirror_score.h"
#include "search/auto.h"
#include "search/methods.h"

namespace symsurf {

namespace {

// Spheres closer than this are one, for suppress_non_maxima.
constexpr double alike_spheres = 0.04;

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

// Spheres so large that they may be planes. Each meets the plane that touches it where it is
// nearest to the cloud's middle, fitted in the same way.

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

// Takes out of the candidates those that a plane explains as well, measured on surfels, and returns
// the best few of them.
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

// Drops those without partners that a plane explains as well, measured on points; all but where
// there is nothing else. Those that differ from a plane by rounding only go in any case.
void drop_planes(const Refinement& refinement, std::vector<SphereCandidate>& candidates) {
  drop(
      [&](const SphereCandidate& c) {
        return c.partnered == 0 && fitted_plane(refinement, c.shape).support >
                                       as_much * refinement.support(c.shape, looked_at);
      },
      candidates);
}

// The same by the score, with partners or without.
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

// The best `count` spheres that differ, on the thinned cloud alone: from pairs of surfels, of any
// radius, refined on the surfels. Behind them the best of those that fit the surfels no better than
// a plane.
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

constexpr std::size_t finalists = 8;         // are fitted to the full cloud
constexpr std::size_t polished_spheres = 3;  // and of these, to ever more of it
constexpr double least_rest = 0.25;          // of the cloud: worth a search of its own
constexpr Index patches_again = 3;  // times as many, where no sphere found has partners of its own

// More for fewer spheres.
constexpr Fit of_each_sphere{.samples = 400, .steps = 4}, of_finalist{.samples = 800, .steps = 3},
    of_polished_sphere{.samples = 3000, .steps = 3}, of_bent{.samples = 3000, .steps = 40};
constexpr Index compared_on = 1200;  // points, of the spheres that are ranked

bool any_partnered(const std::vector<SphereCandidate>& candidates) {
  return std::any_of(candidates.begin(), candidates.end(),
                     [](const SphereCandidate& c) { return c.partnered > 0; });
}

void fit_each(std::vector<SphereCandidate>& candidates, const Refinement& refinement,
              const PartnerFit& partner_fit) {
  for (SphereCandidate& candidate : candidates)
    candidate = partner_fit(refinement.fitted(candidate, of_each_sphere));
}

// Where the best sphere leaves much of the cloud without partners, that may have a sphere of its
// own: both spheres of two half balls are found of 8 in 8, not of 6.
std::vector<SphereCandidate> spheres_of_rest(const Cloud& cloud, const SphereCandidate& best,
                                             const PartnerFit& whole, Index sample_size,
                                             const Context& context) {
  if (best.partnered == 0) return {};
  const Points unpaired = whole.unpaired_points(best.shape);
  const auto least = least_rest * static_cast<double>(cloud.points.size());
  if (static_cast<double>(unpaired.rows()) < least) return {};
  Cloud rest = cloud;
  rest.set_points(unpaired, {});
  const Surfels& surfels = rest.patches(sample_size, context.stage(0, 0.2));
  const NearestPoints points(rest, context.stage(0.2, 0.2));
  const Surfels& fine = rest.patches(samples_a_patch * sample_size, context.stage(0.8, 1));
  const Refinement refinement(rest, points, surfels, fine);
  const PartnerFit partner_fit(rest, points, rest.tree(context), refinement.spacing(), context);
  std::vector<SphereCandidate> found = promising_spheres(surfels, SurfelMap(surfels), cloud.seed,
                                                         2 * finalists, context.stage(0.2, 0.8));
  fit_each(found, refinement, partner_fit);
  std::erase_if(found, [](const SphereCandidate& c) { return c.partnered == 0; });
  return found;
}

// The fitted spheres of the cloud, the best first; none where planes explain as much.
std::vector<SphereCandidate> searched_spheres(const Cloud& cloud, const Surfels& surfels,
                                              std::vector<SphereCandidate> candidates,
                                              Index sample_size, const Refinement& refinement,
                                              const PartnerFit& partner_fit,
                                              const Context& context) {
  fit_each(candidates, refinement, partner_fit);
  if (!any_partnered(candidates)) {
    const Context unreported = context.stage(0, 0);
    const Surfels& finer = cloud.patches(patches_again * sample_size, unreported);
    std::vector<SphereCandidate> more =
        promising_spheres(finer, SurfelMap(finer), cloud.seed, 2 * finalists, unreported);
    fit_each(more, refinement, partner_fit);
    candidates.insert(candidates.end(), more.begin(), more.end());
  }
  drop_planes(refinement, candidates);
  if (candidates.empty()) return candidates;
  sort_best_first(candidates);
  const std::vector<SphereCandidate> more =
      spheres_of_rest(cloud, candidates.front(), partner_fit, sample_size, context);
  candidates.insert(candidates.end(), more.begin(), more.end());
  suppress_non_maxima(surfels, candidates, alike_spheres, finalists);
  return candidates;
}

// On ever more points, those without partners along the surfaces as well.
void refine(std::vector<SphereCandidate>& candidates, const Surfels& surfels,
            const Refinement& refinement, const PartnerFit& partner_fit) {
  for (SphereCandidate& candidate : candidates)
    if (candidate.partnered == 0) candidate = refinement.fitted(candidate, of_finalist);
  suppress_non_maxima(surfels, candidates, alike_spheres, finalists);
  for (std::size_t i = 0; i < std::min(polished_spheres, candidates.size()); ++i) {
    SphereCandidate& candidate = candidates[i];
    if (candidate.partnered == 0)
      candidate = polished(candidate, of_polished_sphere, refinement);
    else
      candidate.shape = partner_fit.refined(candidate.shape, of_polished_sphere.samples);
  }
  for (SphereCandidate& candidate : candidates)
    if (candidate.partnered > 0)
      candidate.support = refinement.support(candidate.shape, compared_on);
}

Result run_sphere(const Cloud& cloud, const ParameterValues& values, const Context& context) {
  Result best;
  best.method = "sphere";
  const Index sample_size = values.integer("sample_size");
  const Surfels& surfels = cloud.patches(sample_size, context.stage(0, 0.1));
  const std::vector<SphereCandidate> rough = promising_spheres(
      surfels, SurfelMap(surfels), cloud.seed, 2 * finalists, context.stage(0.1, 0.4));

  const NearestPoints points(cloud, context.stage(0.4, 0.5));
  const Surfels& fine = cloud.patches(samples_a_patch * sample_size, context.stage(0.5, 0.6));
  const Refinement refinement(cloud, points, surfels, fine);
  const PartnerFit partner_fit(cloud, points, cloud.tree(context), refinement.spacing(), context);
  std::vector<SphereCandidate> candidates = searched_spheres(
      cloud, surfels, rough, sample_size, refinement, partner_fit, context.stage(0.6, 0.7));
  if (candidates.empty()) return best;
  refine(candidates, surfels, refinement, partner_fit);
  const MirrorScore score(cloud, context.stage(0.7, 0.75));
  drop_planes(refinement, score, cloud.frame, candidates);
  if (candidates.empty()) return best;
  suppress_non_maxima(surfels, candidates, alike_spheres, 1 + values.integer("max_candidates"));
  std::vector<std::shared_ptr<Mirror>> mirrors;
  for (const SphereCandidate& candidate : candidates)
    mirrors.push_back(std::make_shared<Sphere>(in_input_units(candidate.shape, cloud.frame)));
  best = score.ranked("sphere", mirrors);
  add_pairs(best, cloud, values, context.stage(0.75, 1));
  return best;
}

std::shared_ptr<Mirror> bent_sphere(const PlaneBend& bend, const Refinement& refinement,
                                    const PrincipalFrame& frame) {
  const SphereCandidate start{bend.sphere()};
  return std::make_shared<Sphere>(in_input_units(refinement.fitted(start, of_bent).shape, frame));
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
  method.run = run_sphere;
  return method;
}

}  // namespace symsurf
