#include <symsurf/sphere.h>

#include <algorithm>

#include "methods/common_parameters.h"
#include "methods/parametric/refinement.h"
#include "methods/parametric/surface_slide.h"
#include "methods/registry.h"
#include "methods/sphere/large_spheres.h"
#include "methods/sphere/partner_fit.h"
#include "methods/sphere/settled_sphere.h"
#include "methods/sphere/sphere_candidates.h"
#include "score/matching.h"
#include "score/mirror_score.h"

namespace symsurf {

namespace {

constexpr std::size_t finalists = 8;          // are fitted to the full cloud
constexpr std::size_t polished_spheres = 3;   // and of these, to ever more of it
constexpr double promising = 0.8;             // and from here on worth sliding
constexpr double symmetric = 0.35;            // more than what shapes without a mirror explain
constexpr double on_surfaces = 0.97;          // of its support before
constexpr double partnered_by_chance = 0.25;  // fewer partners than that prove nothing
constexpr double least_rest = 0.25;           // of the cloud: worth a search of its own
constexpr double partnered_exactly = 0.8;     // partners that need no surfaces
constexpr Index patches_again = 3;  // times as many, where no sphere found has partners of its own
constexpr int most_slides = 3;      // of one sphere, at the most

bool any_partnered(const std::vector<SphereCandidate>& candidates) {
  return std::any_of(candidates.begin(), candidates.end(),
                     [](const SphereCandidate& c) { return c.partnered > 0; });
}

// Through noise some points meet others by chance: that outweighs no surface.
void drop_chance_partners(std::vector<SphereCandidate>& candidates) {
  double most = 0;
  for (const SphereCandidate& c : candidates) most = std::max(most, c.support);
  for (SphereCandidate& c : candidates)
    if (c.partnered < partnered_by_chance && c.support < on_surfaces * most) c.partnered = 0;
}

// As far as each slide brings it nearer, and off no surface.
SphereCandidate slid(SphereCandidate candidate, const ParametricRefinement& refinement,
                     const PartnerFit& partner_fit) {
  for (int k = 0; k < most_slides; ++k) {
    SphereCandidate next = partner_fit.slid(candidate, refinement.loosest(candidate.shape));
    if (next.partnered <= candidate.partnered) break;
    next.support = refinement.support(next.shape, 800);
    if (next.support < on_surfaces * candidate.support) break;
    candidate = next;
  }
  return candidate;
}

// Onto partners; where noise hides these, and it is worth the time, along the surfaces before.
SphereCandidate through_noise(const SphereCandidate& fitted, bool is_best,
                              const ParametricRefinement& refinement,
                              const PartnerFit& partner_fit) {
  const SphereCandidate on_partners = slid(fitted, refinement, partner_fit);
  if (on_partners.partnered >= partnered_by_chance || !is_best || fitted.support < symmetric)
    return on_partners;
  return slid(slid_along_surfaces(fitted, refinement), refinement, partner_fit);
}

// Where the best sphere leaves much of the cloud without partners, that may have a sphere of its
// own.
std::vector<SphereCandidate> spheres_of_rest(const Cloud& cloud, const SphereCandidate& best,
                                             const PartnerFit& whole, Index sample_size,
                                             const Context& context) {
  if (best.partnered == 0) return {};
  const Points unmet = whole.unmet(best.shape);
  const auto least = least_rest * static_cast<double>(cloud.points.size());
  if (static_cast<double>(unmet.rows()) < least) return {};
  Cloud rest = cloud;
  rest.points = unmet;
  rest.partition = Partition(unmet.rows());
  rest.normals = {};
  const Surfels surfels(rest, sample_size, context.stage(0, 0.2));
  const PointTree tree(rest.points, context.stage(0.2, 0.2));
  const NearestPoints points(rest.points, tree, context);
  const ParametricRefinement refinement(rest, points, tree, surfels, context.stage(0.8, 1));
  const PartnerFit partner_fit(rest, points, tree, refinement.spacing(), context);
  std::vector<SphereCandidate> found;
  for (const SphereCandidate& candidate : promising_spheres(
           surfels, SurfelMap(surfels), cloud.seed, 2 * finalists, context.stage(0.2, 0.8))) {
    const SphereCandidate fitted = partner_fit(refinement.fitted(candidate, 400, 4));
    if (fitted.partnered > 0) found.push_back(fitted);
  }
  return found;
}

Result run_sphere(const Cloud& cloud, const ParameterValues& values, const Context& context) {
  Result best;
  best.method = "sphere";
  const Surfels surfels(cloud, values.integer("sample_size"), context.stage(0, 0.1));
  const SurfelMap map(surfels);
  std::vector<SphereCandidate> candidates =
      promising_spheres(surfels, map, cloud.seed, 2 * finalists, context.stage(0.1, 0.4));

  PointTree tree(cloud.points, context.stage(0.4, 0.5));
  const NearestPoints points(cloud.points, tree, context);
  const ParametricRefinement refinement(cloud, points, tree, surfels, context.stage(0.6, 0.7));
  const PartnerFit partner_fit(cloud, points, tree, refinement.spacing(), context);
  const auto fit = [&](std::vector<SphereCandidate>& some) {
    for (SphereCandidate& candidate : some)
      candidate = partner_fit(refinement.fitted(candidate, 400, 4));
  };
  fit(candidates);
  if (!any_partnered(candidates)) {
    const Surfels finer(cloud, patches_again * values.integer("sample_size"),
                        context.stage(0.7, 0.7));
    std::vector<SphereCandidate> more = promising_spheres(finer, SurfelMap(finer), cloud.seed,
                                                          2 * finalists, context.stage(0.7, 0.7));
    fit(more);
    candidates.insert(candidates.end(), more.begin(), more.end());
  }
  drop_planes(refinement, candidates);
  if (candidates.empty()) return best;
  sort_best_first(candidates);
  for (const SphereCandidate& candidate :
       spheres_of_rest(cloud, candidates.front(), partner_fit, values.integer("sample_size"),
                       context.stage(0.5, 0.6)))
    candidates.push_back(candidate);
  suppress_non_maxima(surfels, candidates, alike_spheres, finalists);
  for (SphereCandidate& candidate : candidates)
    if (candidate.partnered == 0) {
      candidate = refinement.fitted(candidate, 800, 3);
      if (candidate.merit() >= promising * candidates.front().merit())
        candidate =
            through_noise(candidate, &candidate == &candidates.front(), refinement, partner_fit);
    }
  drop_chance_partners(candidates);
  suppress_non_maxima(surfels, candidates, alike_spheres, finalists);
  for (std::size_t i = 0; i < std::min(polished_spheres, candidates.size()); ++i) {
    SphereCandidate& candidate = candidates[i];
    if (candidate.partnered == 0)
      candidate = refinement.fitted_to_exact_pairs(refinement.fitted(candidate, 3000, 3));
    else
      candidate.shape = partner_fit.refined(candidate.shape, 3000);
  }
  for (SphereCandidate& candidate : candidates)
    if (candidate.partnered > 0) candidate.support = refinement.support(candidate.shape, 1200);
  const MirrorScore score(cloud, points, context.stage(0.7, 0.75));
  drop_planes(refinement, score, cloud.frame, candidates);
  if (candidates.empty()) return best;
  suppress_non_maxima(surfels, candidates, alike_spheres, 1 + values.integer("max_candidates"));

  SphereCandidate& first = candidates.front();
  if (first.partnered == 0 || partner_fit.closeness(first.shape) < partnered_exactly)
    first.shape = settled_on_surfaces(first, refinement).shape;
  std::vector<std::shared_ptr<Mirror>> mirrors;
  for (const SphereCandidate& candidate : candidates)
    mirrors.push_back(std::make_shared<Sphere>(in_input_units(candidate.shape, cloud.frame)));
  best = score.ranked("sphere", mirrors);
  add_pairs(best, cloud.points, std::move(tree), *best.mirror,
            values.real("pair_distance") * cloud.diagonal, context.stage(0.75, 1));
  return best;
}

}  // namespace

MethodImplementation sphere_method() {
  MethodImplementation method;
  method.name = "sphere";
  method.title = "Mirror sphere";
  method.summary =
      "Finds the sphere that mirrors the shape best, of any radius: candidates from pairs of "
      "points, Hruda's measure over all pairs, refined on the full cloud.";
  method.parameters = {
      surfels_searched(700, "the sphere"),
      max_candidates(5, 7, "spheres"),
      pair_distance(),
  };
  method.minimum_points = 5;
  method.automatic = true;
  method.reports_unpaired_points = true;
  method.run = run_sphere;
  return method;
}

}  // namespace symsurf
