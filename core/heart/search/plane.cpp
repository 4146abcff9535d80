#include "search/plane.h"

#include <symsurf/mirrors.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/linear_algebra.h"
#include "base/math.h"
#include "base/parallel.h"
#include "cloud/cloud.h"
#include "cloud/exact_isometries.h"
#include "cloud/point_tree.h"
#include "cloud/surface_points.h"
#include "fit/candidate.h"
#include "fit/refinement.h"
#include "fit/shapes.h"
#include "pairing/matching.h"
#include "score/mirror_score.h"
#include "search/methods.h"

namespace symsurf {

namespace {

constexpr double shortest_chord = 0.04;
constexpr double facing_cosine = 0.88;  // 28 degrees
constexpr Index seeds = 200;            // surfels that pairs are made of
constexpr double glanced_at = 3000;     // planes of these, on average
constexpr double looked_at = 800, looked_at_closely = 150;
constexpr Index glance = 8, first_look = 24, second_look = 100;  // surfels a candidate is tried on
constexpr double search_tolerance = 0.015;
constexpr double least_explained = 0.1;
constexpr double blind = 0.6;  // of a pair with normals: more are tried where there are none

// Thins pairs evenly and each by itself, so that one pair more or less changes no other's lot.
std::uint32_t ticket(Index i, Index j) {
  const std::uint32_t mixed =
      static_cast<std::uint32_t>(i) * 2654435761u ^ static_cast<std::uint32_t>(j) * 2246822519u;
  return mixed ^ mixed >> 15;
}

UnitPlane plane_between(const Vector3& a, const Vector3& b) {
  const Vector3 normal = (b - a).normalized();
  return {normal, -normal.dot(a + b) / 2};
}

void keep_best(std::vector<PlaneCandidate>& candidates, double count) {
  if (static_cast<double>(candidates.size()) <= count) return;
  sort_best_first(candidates);
  candidates.resize(static_cast<std::size_t>(count));
}

}  // namespace

std::vector<PlaneCandidate> candidate_planes(const Surfels& surfels, const SurfelMap& map,
                                             Index count) {
  const Index step = std::max<Index>(1, surfels.size() / seeds);
  const Index glancing = std::max<Index>(1, surfels.size() / glance);
  const Index coarse = std::max<Index>(1, surfels.size() / first_look);
  struct Pair {
    std::uint32_t ticket;
    std::int32_t i, j;
  };
  std::vector<Pair> pairs;
  double informative = 0;
  for (Index i = 0; i < surfels.size(); i += step)
    for (Index j = i + step; j < surfels.size(); j += step) {
      const Surfel &a = surfels[i], &b = surfels[j];
      const Vector3 chord = b.position - a.position;
      const double squared = chord.squaredNorm();
      if (squared < shortest_chord * shortest_chord) continue;
      const bool surfaces = a.flatness * b.flatness > 0.25;
      const double cosine =
          a.normal.dot(b.normal) - 2 * chord.dot(a.normal) * chord.dot(b.normal) / squared;
      if (surfaces && std::abs(cosine) < facing_cosine) continue;
      informative += surfaces ? 1 : blind;
      pairs.push_back({ticket(i, j), static_cast<std::int32_t>(i), static_cast<std::int32_t>(j)});
    }

  std::vector<PlaneCandidate> found;
  const double last_ticket = glanced_at / informative * std::numeric_limits<std::uint32_t>::max();
  for (const auto& [ticket, i, j] : pairs) {
    if (ticket > last_ticket) continue;
    const UnitPlane plane = plane_between(surfels[i].position, surfels[j].position);
    const double support =
        support_share(surfels, map, plane, search_tolerance, glancing, contradiction);
    if (support > least_explained) found.push_back({plane, support});
  }
  keep_best(found, looked_at);

  for (PlaneCandidate& candidate : found)
    candidate.support =
        support_share(surfels, map, candidate.shape, search_tolerance, coarse, contradiction);
  std::erase_if(found, [](const PlaneCandidate& c) { return c.support <= least_explained; });
  keep_best(found, looked_at_closely);
  const Index fine = std::max<Index>(1, surfels.size() / second_look);
  for (PlaneCandidate& candidate : found)
    candidate.support =
        support_share(surfels, map, candidate.shape, search_tolerance, fine, contradiction);
  suppress_non_maxima(found, 0.08, count);
  return found;
}

namespace {

constexpr double thin = 2;  // patches: the standard deviation of a body whose sides they mix
constexpr double beside_exact = 0.3;  // of the best support, below which none is a candidate then

constexpr Index started = 20;    // candidates that are refined on the surfels, roughly
constexpr Index promising = 10;  // of these, are fitted to the full cloud
constexpr double far_below_best_on_surfels = 0.6;  // by this share of it: not worth fitting

}  // namespace

std::vector<PlaneCandidate> promising_planes(const Surfels& surfels, const SurfelMap& map,
                                             const Context& context) {
  std::vector<PlaneCandidate> candidates = candidate_planes(surfels, map, started);
  if (candidates.empty()) candidates.push_back({UnitPlane{}, 0});
  for (PlaneCandidate& candidate : candidates)
    candidate = refined_on_surfels(surfels, map, candidate, 0.04, 0.02, 3, 3, contradiction);
  suppress_non_maxima(candidates, alike_planes, started);
  context.report(0.5);
  drop_far_below_best(candidates, far_below_best_on_surfels);
  suppress_non_maxima(candidates, alike_planes, promising);
  context.report(1);
  return candidates;
}

namespace {

// The best that a search finds, refined.
std::vector<UnitPlane> searched_planes(const Cloud& cloud, const Surfels& surfels,
                                       const Refinement& refinement, const MirrorScore& score,
                                       std::vector<PlaneCandidate> candidates,
                                       const Context& context) {
  fit_to_all(candidates, refinement, score, cloud.frame, quick, context.stage(0, 0.7));
  suppress_non_maxima(candidates, alike_planes, refined_at_most);
  // Of a body thinner than the patches these say nothing about the plane along it.
  if (std::sqrt(cloud.frame.variance.z()) < thin * surfels.spacing() * cloud.frame.size)
    candidates.push_back({{Vector3::UnitZ(), 0}, 0});
  improve(candidates, context.stage(0.7, 1), [&](const PlaneCandidate& c) {
    return PlaneCandidate{refinement.refined(c.shape), c.support};
  });
  suppress_non_maxima(candidates, alike_planes, static_cast<Index>(candidates.size()));
  std::vector<UnitPlane> planes;
  for (const PlaneCandidate& candidate : candidates) planes.push_back(candidate.shape);
  return planes;
}

// The planes of a mesh of which some vertices stand on both sides, as most do where a part of a
// symmetric mesh was cut off or moved: through these, to rounding.
void fit_to_vertices(std::vector<UnitPlane>& planes, const Cloud& cloud, const Context& context) {
  const Cloud& mesh = *cloud.vertices;
  const NearestPoints vertices(mesh, context);
  const double spacing = surface_spacing(mesh.points, mesh.tree(context));
  const PrincipalFrame& frame = cloud.frame;
  std::vector<Vector3> corners;
  for (Index i = 0; i < mesh.points.size(); ++i) corners.push_back(frame.to_frame(mesh.points[i]));
  for (UnitPlane& plane : planes)
    plane = fitted_to_exact_pairs(plane, corners, vertices, frame, spacing / frame.size)
                .value_or(plane);
}

bool is_one_of(const UnitPlane& a, const std::vector<UnitPlane>& planes) {
  return std::any_of(planes.begin(), planes.end(), [&](const UnitPlane& b) {
    const double sign = a.normal.dot(b.normal) < 0 ? -1 : 1;
    return (a.normal - sign * b.normal).norm() < alike_planes &&
           std::abs(a.offset - sign * b.offset) < alike_planes;
  });
}

Result run_plane(const Cloud& cloud, const ParameterValues& values, const Context& context) {
  const Index sample_size = values.integer("sample_size");
  // Either takes about as long, and needs nothing of the other.
  parallel_for(context.stage(0, 0.2), 2, 1, [&](Index part, Index) {
    if (part == 0)
      cloud.finer_patches(sample_size, context.stage(0, 0.1));
    else
      cloud.tree(context.stage(0.1, 0.2));
  });
  const Surfels& coarse = cloud.patches(sample_size, context.stage(0, 0.1));
  const Surfels& fine = cloud.finer_patches(sample_size, context.stage(0.1, 0.2));
  const SurfelMap map(coarse);
  const std::vector<PlaneCandidate> promising =
      promising_planes(coarse, map, context.stage(0.2, 0.25));

  const NearestPoints points(cloud, context.stage(0.25, 0.4));
  const Refinement refinement(cloud, points, coarse, fine);
  const MirrorScore score(cloud, context.stage(0.4, 0.45));
  const auto ranked = [&](const std::vector<UnitPlane>& planes) {
    std::vector<Plane> posed;
    for (const UnitPlane& plane : planes) posed.push_back(in_input_units(plane, cloud.frame));
    longest_first(posed, cloud.frame);
    std::vector<std::shared_ptr<Mirror>> mirrors;
    for (const Plane& plane : posed) mirrors.push_back(std::make_shared<Plane>(plane));
    return score.ranked("plane", mirrors);
  };
  const bool is_mesh = cloud.vertices != nullptr;
  std::vector<UnitPlane> planes;
  for (const Plane& plane : is_mesh ? cloud.vertex_planes : exact_planes(cloud, context)) {
    const UnitPlane framed = in_frame(plane, cloud.frame);
    planes.push_back(is_mesh ? framed : refinement.exact(framed));
  }
  Result best;
  if (!planes.empty()) best = ranked(planes);
  // Of planes of the vertices alone faces are missing on one side.
  const bool is_exact = !planes.empty() && !(is_mesh && best.score < 1);
  const bool is_flat = cloud.frame.variance.z() < std::pow(single_rounding * cloud.frame.size, 2);
  const auto is_known = [&](const PlaneCandidate& c) { return is_one_of(c.shape, planes); };
  std::vector<PlaneCandidate> others = promising;
  if (is_exact) {
    drop_far_below_best(others, beside_exact);
    std::erase_if(others, is_known);
  }
  std::vector<UnitPlane> more;
  if (!others.empty()) {
    more = searched_planes(cloud, coarse, refinement, score, others, context.stage(0.46, 0.55));
    if (is_mesh) fit_to_vertices(more, cloud, context.stage(0.55, 0.55));
    std::erase_if(more, [&](const UnitPlane& plane) {
      return is_one_of(plane, planes) || (is_exact && is_flat && std::abs(plane.normal.z()) > 0.5);
    });
  }
  if (is_exact && !more.empty()) {
    // They come behind it, however well they score at the sampling.
    Result rest = ranked(more);
    const std::vector<Result> worse = std::exchange(rest.candidates, {});
    best.candidates.push_back(std::move(rest));
    best.candidates.insert(best.candidates.end(), worse.begin(), worse.end());
  } else if (!is_exact) {
    planes.insert(planes.end(), more.begin(), more.end());
    best = ranked(planes);
  }
  const auto most = static_cast<std::size_t>(values.integer("max_candidates"));
  if (best.candidates.size() > most) best.candidates.resize(most);
  add_pairs(best, cloud, values, context.stage(0.55, 1));
  return best;
}

}  // namespace

MethodImplementation plane_method() {
  MethodImplementation method;
  method.name = "plane";
  method.title = "Mirror plane";
  method.summary = "Finds the plane that mirrors the shape best, refined on the full cloud.";
  method.parameters = {
      surfels_searched(1000, "the plane"),
      max_candidates(64, 64, "planes"),
      pair_distance(),
  };
  method.automatic = true;
  method.reports_unpaired_points = true;
  method.reports_mean_residual = true;
  method.run = run_plane;
  return method;
}

}  // namespace symsurf
