#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>

#include "base/math.h"
#include "base/parallel.h"
#include "cloud/exact_isometries.h"
#include "fit/bent_plane.h"
#include "search/perpendicular.h"
#include "search/plane.h"

namespace symsurf::perpendicular {

namespace {

constexpr Index patches = 1000, best_planes = 6;  // of the cloud; candidates
constexpr double alike = 0.05;                    // mirrors closer than this are one
constexpr Index few = 600, many = 2000;           // points that planes are bent by
constexpr std::size_t most_bent = 3;              // to the end
constexpr double unbent = 0.997;                  // flatness of what is a plane still
constexpr double beyond_others = 1.1;  // of their support, what planes half-way must have

// From a stiff plane that looks far to one that bends and looks near. It is soft before it looks
// near: a stiff one has lost the ends of a body by then. Curvature that is the same everywhere
// costs nothing: saddles, domes and twists are found at once. Chosen on bodies of 10,000 points
// (`make accuracy OPTIONS="--cases bodies"`).
constexpr int stages = 18, first_stages = 6, steps_a_stage = 2;
constexpr double widest = 0.09;  // diagonals
constexpr double stiffest = 1e-3, softest = 1e-8;
constexpr double soft_from = 0.6, looks_far = 1.5;  // share of the stages; exponent
constexpr bool is_finer(int stage) { return stage == 4 || stage == 8; }

double tolerance_at(double part, double last) {
  return widest * std::pow(last / widest, std::pow(part, looks_far));
}
double stiffness_at(double part) {
  return stiffest * std::pow(softest / stiffest, std::min(1.0, part / soft_from));
}

// Half-way between the principal planes: what twists a body turns its axes, too. Without them 3 of
// 4 twisted bodies are right, with them all.
std::vector<UnitPlane> half_way_planes() {
  std::vector<UnitPlane> planes;
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {1.0, -1.0})
      planes.push_back(
          {(Vector3::Unit(axis) + side * Vector3::Unit((axis + 1) % 3)).normalized(), 0});
  return planes;
}

std::vector<UnitPlane> candidate_mirrors(const Cloud& cloud, const Context& context) {
  const Surfels& surfels = cloud.patches(patches, context);
  const SurfelMap map(surfels);
  std::vector<PlaneCandidate> candidates = candidate_planes(surfels, map, 2 * best_planes);
  suppress_non_maxima(candidates, alike, best_planes);
  for (int axis = 0; axis < 3; ++axis) candidates.push_back({{Vector3::Unit(axis), 0}, 0});
  suppress_non_maxima(candidates, alike, best_planes + 3);
  std::vector<UnitPlane> planes;
  for (const PlaneCandidate& candidate : candidates) planes.push_back(candidate.shape);
  return planes;
}

BentPlane laid_on(const SearchCloud& search, const Plane& plane) {
  const Vector3 point = plane.foot(search.centroid) - search.centroid;
  return {search, search.axes.transpose() * point / search.diagonal,
          search.axes.transpose() * plane.normal()};
}

void bend(const SearchCloud& search, int from, int to, Index points, BentPlane& plane) {
  const Index stride = std::max<Index>(1, search.size() / points);
  for (int stage = from; stage < to; ++stage) {
    search.context.check();
    if (is_finer(stage)) plane.subdivide();
    const double part = stage / (stages - 1.0);
    const double tolerance = tolerance_at(part, search.tolerance());
    for (int k = 0; k < steps_a_stage; ++k)
      plane.step(tolerance, stiffness_at(part), stride, search.context);
  }
}

// Whether they send points to like positions.
bool act_alike(const SearchCloud& search, const BentPlane& a, const BentPlane& b) {
  constexpr Index probes = 40;
  const Index stride = std::max<Index>(1, search.size() / probes);
  double squared = 0;
  Index count = 0;
  for (Index p = 0; p < search.size(); p += stride, ++count) {
    const Vector3 x = search.point(search.tree.order()[p]);
    squared += (a.image(x) - b.image(x)).squaredNorm();
  }
  return squared < alike * alike * static_cast<double>(count);
}

}  // namespace

bool lay_exact_planes(const Cloud& cloud, const SearchCloud& search,
                      std::vector<GrownSurface>& surfaces, const Context& context) {
  const std::vector<Plane> planes = exact_planes(cloud, context);
  for (std::size_t k = 0; k < std::min(planes.size(), most_bent); ++k) {
    GrownSurface surface;
    surface.mirror = laid_on(search, planes[k]).free_form();
    match(search, single_rounding, surface);
    surface.exact = surface.bent = true;
    surface.support = 1;
    surfaces.push_back(std::move(surface));
  }
  return !planes.empty();
}

void bend_planes(const Cloud& cloud, const SearchCloud& search, std::vector<GrownSurface>& surfaces,
                 const Context& context) {
  std::vector<UnitPlane> planes = candidate_mirrors(cloud, context.stage(0, 0.1));
  const auto candidates = static_cast<std::ptrdiff_t>(planes.size());
  for (const UnitPlane& plane : half_way_planes()) planes.push_back(plane);
  std::vector<BentPlane> bent;
  for (const UnitPlane& plane : planes)
    bent.push_back(laid_on(search, in_input_units(plane, cloud.frame)));
  silent_parallel_for(search.context, static_cast<Index>(bent.size()), 1,
                      [&](Index k, Index) { bend(search, 0, first_stages, few, bent[k]); });
  double best = 0;
  const auto half_way = bent.begin() + candidates;
  std::for_each(bent.begin(), half_way,
                [&](const BentPlane& one) { best = std::max(best, one.support()); });
  const auto is_beyond = [&](const BentPlane& one) { return one.support() > beyond_others * best; };
  bent.erase(std::remove_if(half_way, bent.end(), std::not_fn(is_beyond)), bent.end());
  std::stable_sort(bent.begin(), bent.end(), [](const BentPlane& a, const BentPlane& b) {
    return a.support() > b.support();
  });
  suppress_non_maxima(bent, most_bent, [&](const BentPlane& a, const BentPlane& b) {
    return act_alike(search, a, b);
  });
  for (std::size_t k = 0; k < bent.size(); ++k) {
    context.stage(0.4, 1).report(static_cast<double>(k) / most_bent);
    bend(search, first_stages, stages, many, bent[k]);
  }
  std::stable_sort(bent.begin(), bent.end(), [](const BentPlane& a, const BentPlane& b) {
    return a.support() > b.support();
  });
  for (std::size_t k = 0; k < bent.size(); ++k) {
    GrownSurface surface;
    surface.mirror = bent[k].free_form();
    match(search, single_rounding, surface);
    if (surface.carried.size() < 6) continue;
    // Between noisy sheets a plane explains more than what bends with them, and less truly.
    if (flatness(surface) > unbent && !surface.exact) continue;
    surface.support = support(search, surface);
    surface.bent = true;
    surfaces.push_back(std::move(surface));
  }
}

}  // namespace symsurf::perpendicular
