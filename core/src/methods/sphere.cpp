#include <symsurf/sphere.h>

#include <algorithm>
#include <iterator>

#include "../matching.h"
#include "../mirror_score.h"
#include "../parametric/refinement.h"
#include "../plane/maximise.h"
#include "../sphere/partner_fit.h"
#include "../sphere/sphere_candidates.h"
#include "../sphere/sphere_measure.h"
#include "methods.h"

namespace symsurf {

namespace {

constexpr Index started = 48;              // candidates that are settled on the surfels
constexpr std::size_t climbed = 3;         // of these, have their measure maximised
constexpr std::size_t finalists = 8;       // of these, are fitted to the full cloud
constexpr std::size_t polished = 3;        // and of these, to ever more of it
constexpr double hopeless = 0.6;           // of what the best explains: not worth fitting
constexpr double promising = 0.65;         // and from here on worth sliding
constexpr double least_rest = 0.25;        // of the cloud: worth a search of its own
constexpr int slides = 3;                  // of one sphere, at the most
constexpr double alike = 0.04;             // spheres closer than this are one
constexpr Index measured = 500;            // surfels that the measure is taken over
constexpr double bent = 0.6, largest = 3;  // radii, in diagonals: no plane, nothing but one
constexpr double flat_radius = 30, as_much = 0.9;

Sphere in_input_units(const UnitSphere& sphere, const PrincipalFrame& frame) {
  return {frame.leave(sphere.centre), frame.size * sphere.radius};
}

void drop_hopeless(std::vector<SphereCandidate>& candidates) {
  const double least = hopeless * candidates.front().explained;
  std::erase_if(candidates, [&](const SphereCandidate& c) { return c.explained < least; });
}

// Spheres so large that a plane explains as much; where there is nothing else, they stay.
void drop_planes(const Surfels& surfels, const SurfelMap& map,
                 std::vector<SphereCandidate>& candidates) {
  const auto is_plane = [&](const SphereCandidate& c) {
    if (c.shape.radius > largest) return true;
    if (c.shape.radius < bent) return false;
    const Vector3 up = c.shape.centre.normalized();  // from the cloud's centroid
    const Vector3 foot = c.shape.centre - c.shape.radius * up;
    const SphereCandidate flat{{foot + flat_radius * up, flat_radius}};
    const double explained = settled(surfels, map, flat, 0.03, 0.02, 4, 1).explained;
    return explained > as_much * explained_share(surfels, map, c.shape, 0.02);
  };
  std::vector<SphereCandidate> spheres;
  std::remove_copy_if(candidates.begin(), candidates.end(), std::back_inserter(spheres), is_plane);
  if (!spheres.empty()) candidates = std::move(spheres);
}

// From each of the best candidates to the maximum next to it of Hruda's measure, where that
// explains more.
void climb(const Surfels& surfels, const SurfelMap& map, std::vector<SphereCandidate>& candidates) {
  const Index stride = std::max<Index>(1, surfels.size() / measured);
  Points positions((surfels.size() + stride - 1) / stride, 3);
  for (Index i = 0; i < positions.rows(); ++i)
    positions.row(i) = surfels[i * stride].position.transpose();
  const SphereMeasure measure(positions);
  for (std::size_t i = 0; i < std::min(climbed, candidates.size()); ++i) {
    Eigen::Vector4d s;
    s << candidates[i].shape.centre, candidates[i].shape.radius;
    s = maximise<4>(measure, s, 0.02, 8);
    const UnitSphere sphere{s.head<3>(), s[3]};
    const double explained = explained_share(surfels, map, sphere, 0.02, 3);
    if (explained > candidates[i].explained) candidates[i] = {sphere, explained};
  }
}

// On the thinned cloud alone.
std::vector<SphereCandidate> promising_spheres(const Surfels& surfels, const SurfelMap& map,
                                               std::uint64_t seed, const Context& context) {
  std::vector<SphereCandidate> candidates = candidate_spheres(surfels, map, seed, started, context);
  if (candidates.empty()) candidates.push_back({});
  for (SphereCandidate& candidate : candidates)
    candidate = settled(surfels, map, candidate, 0.04, 0.02, 4, 3);
  drop_planes(surfels, map, candidates);
  keep_distinct(surfels, candidates, alike, started);
  climb(surfels, map, candidates);
  drop_hopeless(candidates);
  for (SphereCandidate& candidate : candidates)
    candidate = settled(surfels, map, candidate, 0.02, 0.012, 4, 1);
  keep_distinct(surfels, candidates, alike, 2 * finalists);
  return candidates;
}

// As far as each slide brings it nearer.
SphereCandidate slid(SphereCandidate candidate, const ParametricRefinement<UnitSphere>& refinement,
                     const PartnerFit& partner_fit) {
  for (int k = 0; k < slides; ++k) {
    const SphereCandidate next = partner_fit.slid(candidate, refinement.loosest(candidate.shape));
    if (next.partnered <= candidate.partnered) break;
    candidate = next;
  }
  return candidate;
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
  rest.total = unmet.rows();
  rest.normals = {};
  const Surfels surfels(rest, sample_size, context.stage(0, 0.2));
  const PointTree tree(rest.points, context.stage(0.2, 0.2));
  const ParametricRefinement<UnitSphere> refinement(rest, tree, surfels, context.stage(0.8, 1));
  const PartnerFit partner_fit(rest, tree, refinement.spacing(), context);
  std::vector<SphereCandidate> found;
  for (const SphereCandidate& candidate :
       promising_spheres(surfels, SurfelMap(surfels), cloud.seed, context.stage(0.2, 0.8))) {
    const SphereCandidate fitted = partner_fit(refinement.fitted(candidate, 400, 4));
    if (fitted.partnered > 0) found.push_back(fitted);
  }
  return found;
}

Result run_sphere(const Cloud& cloud, const ParameterValues& values, const Context& context) {
  const Surfels surfels(cloud, values.integer("sample_size"), context.stage(0, 0.1));
  const SurfelMap map(surfels);
  std::vector<SphereCandidate> candidates =
      promising_spheres(surfels, map, cloud.seed, context.stage(0.1, 0.4));

  PointTree tree(cloud.points, context.stage(0.4, 0.5));
  const ParametricRefinement<UnitSphere> refinement(cloud, tree, surfels, context.stage(0.6, 0.7));
  const PartnerFit partner_fit(cloud, tree, refinement.spacing(), context);
  for (SphereCandidate& candidate : candidates) {
    candidate = refinement.fitted(candidate, 400, 4);
    candidate = partner_fit(candidate);
  }
  sort_best_first(candidates);
  for (const SphereCandidate& candidate :
       spheres_of_rest(cloud, candidates.front(), partner_fit, values.integer("sample_size"),
                       context.stage(0.5, 0.6)))
    candidates.push_back(candidate);
  keep_distinct(surfels, candidates, alike, finalists);
  for (SphereCandidate& candidate : candidates)
    if (candidate.partnered == 0) {
      candidate = refinement.fitted(candidate, 800, 3);
      if (candidate.merit() >= promising * candidates.front().merit())
        candidate = slid(candidate, refinement, partner_fit);
    }
  keep_distinct(surfels, candidates, alike, finalists);
  for (std::size_t i = 0; i < std::min(polished, candidates.size()); ++i) {
    SphereCandidate& candidate = candidates[i];
    if (candidate.partnered == 0)
      candidate = refinement.fitted(candidate, 3000, 3);
    else
      candidate.shape = partner_fit.refined(candidate.shape, 3000);
  }
  for (SphereCandidate& candidate : candidates)
    if (candidate.partnered > 0) candidate.explained = refinement.explained(candidate.shape, 1200);
  drop_planes(surfels, map, candidates);
  keep_distinct(surfels, candidates, alike, 1 + values.integer("max_candidates"));
  context.report(0.7);

  // Partners tell more than sheets, which many spheres map onto each other about as well.
  const auto loose =
      std::stable_partition(candidates.begin(), candidates.end(),
                            [](const SphereCandidate& c) { return c.partnered > 0; });
  for (auto c = candidates.begin(); c != loose; ++c)
    c->partnered = partner_fit.nearness(c->shape, 3000);
  std::stable_sort(candidates.begin(), loose,
                   [](const auto& a, const auto& b) { return a.partnered > b.partnered; });
  std::vector<std::shared_ptr<Mirror>> mirrors;
  for (const SphereCandidate& candidate : candidates)
    mirrors.push_back(std::make_shared<Sphere>(in_input_units(candidate.shape, cloud.frame)));
  Result best = MirrorScore(cloud, tree, context.stage(0.7, 0.75))
                    .ranked("sphere", mirrors, loose - candidates.begin());
  add_pairs(best, cloud.points, std::move(tree), *best.mirror,
            values.real("pair_distance") * cloud.diagonal, context.stage(0.75, 1));
  best.statistics["unpaired_points"] = cloud.points.size() - best.pairs.rows();
  return best;
}

}  // namespace

Method sphere_method() {
  Method method;
  method.name = "sphere";
  method.title = "Mirror sphere";
  method.summary =
      "Finds the sphere that mirrors the shape best, of any radius: candidates from pairs of "
      "points, Hruda's measure over all pairs, refined on the full cloud.";
  method.parameters = {
      Parameter::integer("sample_size", 700, 100, 100000, "points",
                         "Patches of the cloud that the search for the sphere works on."),
      Parameter::integer("max_candidates", 5, 0, 7, "",
                         "Other spheres to report at the most, best first."),
      Parameter::real("pair_distance", 0.05, 0, 1, "diagonal",
                      "A point whose image has no point of the cloud nearer than this has no "
                      "partner."),
  };
  method.minimum_points = 5;
  method.automatic = true;
  method.run = run_sphere;
  return method;
}

}  // namespace symsurf
