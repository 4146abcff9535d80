#include "search/perpendicular.h"

#include <symsurf/mirrors.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <utility>

#include "base/math.h"
#include "base/parallel.h"
#include "cloud/voxel_grid.h"
#include "pairing/matching.h"
#include "score/mirror_score.h"
#include "search/methods.h"

namespace symsurf::perpendicular {

namespace {

constexpr std::size_t most_trials = 20, most_surfaces = 4;  // of either kind of seed
constexpr Index trial_points = 60;
constexpr int trial_refinements = 2, first_rounds = 2;
constexpr std::array<double, 3> seed_distances{12, 6, 3};  // spacings, the least between seeds
constexpr double least_support = 0.3;
constexpr double same_direction = 0.9;
constexpr double enough_support = 0.85;
// Of the support of bent planes. On bodies of 10,000 points whose plane was bent what grows
// supports half as much or less, on sheets two thirds or more.
constexpr double far_behind = 0.6;

// Seeds to try: the best supported first, but far from each other before they crowd.
std::vector<Seed> spread_out(const SearchCloud& cloud, const std::vector<Seed>& seeds,
                             std::size_t most) {
  struct Position {
    Vector3 middle, direction;
  };
  std::vector<Position> positions;
  std::vector<Seed> chosen;
  for (const double spacings : seed_distances) {
    const double apart = spacings * cloud.spacing;
    for (const Seed& seed : seeds) {
      if (chosen.size() == most || seed.support < least_support) break;
      const Vector3 x = cloud.point(seed.first), y = cloud.point(seed.second);
      const Position here{(x + y) / 2, (x - y).normalized()};
      const bool seen = std::any_of(positions.begin(), positions.end(), [&](const Position& other) {
        return (other.middle - here.middle).squaredNorm() < apart * apart &&
               std::abs(other.direction.dot(here.direction)) > same_direction;
      });
      if (seen) continue;
      positions.push_back(here);
      chosen.push_back(seed);
    }
  }
  return chosen;
}

// Whether a surface already mirrors most of what the trial has found.
bool known(const SearchCloud& cloud, const Growth& growth, const GrownSurface& surface) {
  std::size_t agree = 0;
  const double near = 1.5 * cloud.spacing;
  for (const std::int32_t i : growth.accepted()) {
    const Vector3 image = surface.mirror->reflect(cloud.point(i));
    if ((image - cloud.point(growth.partner(i))).squaredNorm() < near * near) ++agree;
  }
  return 2 * agree > growth.accepted().size();
}

// The first steps of at most so many growths from the best seeds, the closest fit first.
std::vector<Growth> trials(const SearchCloud& cloud, const std::vector<Seed>& seeds,
                           std::size_t most) {
  const std::vector<Seed> chosen = spread_out(cloud, seeds, most);
  std::vector<Growth> growths;
  for (const Seed& seed : chosen) growths.emplace_back(cloud, seed);
  const auto is_long = [](const Growth& growth) {
    return static_cast<Index>(growth.accepted().size()) >= trial_points / 2;
  };
  silent_parallel_for(cloud.context, static_cast<Index>(growths.size()), 1,
                      [&](Index begin, Index) {
                        Growth& growth = growths[begin];
                        growth.grow(trial_points);
                        if (!is_long(growth)) return;
                        for (int k = 0; k < trial_refinements; ++k) growth.refine();
                      });
  std::erase_if(growths, [&](const Growth& growth) { return !is_long(growth); });
  std::stable_sort(growths.begin(), growths.end(),
                   [](const Growth& a, const Growth& b) { return a.closeness() > b.closeness(); });
  return growths;
}

double most_support(const std::vector<GrownSurface>& surfaces) {
  double most = 0;
  for (const GrownSurface& surface : surfaces) most = std::max(most, surface.support);
  return most;
}

// Adds the surfaces grown from trials, each from one that no surface before mirrors. In the order
// found. Gives up where the first stays far behind a support that others have.
void explore(const SearchCloud& cloud, std::vector<Growth> trials, double others,
             std::vector<GrownSurface>& surfaces, const Context& context) {
  double best = most_support(surfaces);
  std::size_t grown = 0;
  for (Growth& growth : trials) {
    context.report(static_cast<double>(grown) / most_surfaces);
    if (std::any_of(surfaces.begin(), surfaces.end(),
                    [&](const GrownSurface& surface) { return known(cloud, growth, surface); }))
      continue;
    growth.grow(cloud.size());
    if (++grown > most_surfaces) break;
    GrownSurface surface;
    for (const std::int32_t i : growth.accepted()) surface.carried.push_back(growth.carried(i));
    refine(cloud, first_rounds, surface);
    if (!surface.mirror) continue;
    best = std::max(best, surface.support);
    const bool enough = surface.support > enough_support && !is_flat(surface);
    surfaces.push_back(std::move(surface));
    if (enough || best < far_behind * others) break;
  }
}

constexpr int last_rounds = 8;
constexpr std::size_t most_refined = 3;
constexpr double worth_refining = 0.7;  // support, of the best

bool has_more_support(const GrownSurface& a, const GrownSurface& b) {
  return a.support > b.support;
}

// Refines the best to the end. The one of the most support comes first.
void refine_best(const SearchCloud& cloud, std::vector<GrownSurface>& surfaces,
                 const Context& context) {
  std::stable_sort(surfaces.begin(), surfaces.end(), has_more_support);
  const double least = surfaces.empty() ? 0 : worth_refining * surfaces[0].support;
  for (std::size_t k = 0; k < std::min(surfaces.size(), most_refined); ++k) {
    context.report(static_cast<double>(k) / most_refined);
    const GrownSurface& surface = surfaces[k];
    if (surface.support < least) break;
    const bool laid = surface.support >= 1;
    if (laid || (surface.bent && !surface.exact)) continue;
    GrownSurface refined = surface;
    refine(cloud, last_rounds, refined);
    if (refined.mirror && refined.support > surface.support) surfaces[k] = std::move(refined);
  }
  std::stable_sort(surfaces.begin(), surfaces.end(), has_more_support);
}

constexpr std::size_t few_trials = 6;
constexpr double close_as_exact = 0.9;  // on bodies whose sides have points of their own: 0.8

double best_closeness(const std::vector<Growth>& trials) {
  return trials.empty() ? 0 : trials.front().closeness();
}

// Whether points have exact partners: smoothing would spoil them.
bool has_exact_partners(const SearchCloud& cloud, const Seeds& seeds) {
  for (const std::vector<Seed>* kind : {&seeds.along, &seeds.across})
    for (const Growth& growth : trials(cloud, *kind, few_trials))
      if (growth.exact() && growth.closeness() > 0.6) return true;
  return false;
}

}  // namespace

Search search(const Cloud& cloud, Index sample_size, const Context& context) {
  Search search{SearchCloud(cloud, sample_size, context.stage(0, 0.2)), {}};
  Seeds seeds = find_seeds(search.cloud, cloud.seed, context.stage(0.2, 0.4));
  if (search.cloud.noisy() && !has_exact_partners(search.cloud, seeds)) {
    search.cloud.smooth(context.stage(0.4, 0.45));
    seeds = find_seeds(search.cloud, cloud.seed, context.stage(0.45, 0.6));
  }
  std::vector<Growth> along = trials(search.cloud, seeds.along, most_trials),
                      across = trials(search.cloud, seeds.across, most_trials);
  const bool exact =
      best_closeness(along) > close_as_exact || best_closeness(across) > close_as_exact;
  std::vector<GrownSurface> bent;
  // Of a thinned cloud even a surface that grows on exact partners is bent where they are lost.
  const bool laid = search.cloud.size() < cloud.points.size() &&
                    lay_exact_planes(cloud, search.cloud, bent, context.stage(0.6, 0.63));
  if (!exact && !laid) bend_planes(cloud, search.cloud, bent, context.stage(0.63, 0.75));
  const double others = most_support(bent);
  explore(search.cloud, std::move(along), others, search.surfaces, context.stage(0.75, 0.8));
  // Others than exact ones meet by chance, and lose mirrors of sheets when they grow.
  if (best_closeness(across) > close_as_exact)
    explore(search.cloud, std::move(across), others, search.surfaces, context.stage(0.8, 0.85));
  std::move(bent.begin(), bent.end(), std::back_inserter(search.surfaces));
  refine_best(search.cloud, search.surfaces, context.stage(0.85, 1));
  return search;
}

bool has_exact_partners(const Cloud& cloud, const ParameterValues& values, const Context& context) {
  const SearchCloud all(cloud, values.integer("sample_size"), context);
  return has_exact_partners(all, find_seeds(all, cloud.seed, context));
}

namespace {

// Farther than `beyond` from the feet of pairs a mirror is extrapolated; points closer to each
// other than `close` are no pair for that. In diagonals, and in spacings where these are longer.
constexpr double beyond = 0.05, close = 0.03, sparse = 3;
constexpr double voxels_within = 0.4;  // of what is near: edges that a voxel's middle stands for

// Where partners are exact they agree about each other, or lie on the image: beside a crease the
// nearest part of the mirror is another for the partner. A point as near to its own image as others
// to theirs lies on the mirror. Where partners are not exact no point is its own, and the surface
// may end before it reaches the middle between two.
void drop_false_pairs(Result& result, const Cloud& cloud, bool exact, double spacing) {
  constexpr double on_image = 0.15;  // spacings
  constexpr double as_near = 2;
  if (result.pairs.rows() == 0) return;
  const std::vector<double> residuals(result.residuals.begin(), result.residuals.end());
  const double on_mirror =
      exact ? std::max(double_rounding * cloud.diagonal, as_near * median(residuals)) : -1;
  std::vector<Index> partner(cloud.points.size(), -1);
  for (Index row = 0; row < result.pairs.rows(); ++row)
    partner[result.pairs(row, 0)] = result.pairs(row, 1);
  std::vector<Index> kept;
  for (Index row = 0; row < result.pairs.rows(); ++row) {
    const Index i = result.pairs(row, 0), j = result.pairs(row, 1);
    const double residual = result.residuals[row];
    if (j == i && residual > on_mirror) continue;
    if (exact && partner[j] != i && residual > on_image * spacing) continue;
    if (result.surface_points.row(row).allFinite()) kept.push_back(row);
  }
  keep_pairs(result, kept);
}

void pair_points(Result& result, const Cloud& cloud, const SearchCloud& searched,
                 const GrownSurface& surface, double pair_distance, const Context& context) {
  const double spacing = searched.spacing * searched.diagonal;
  // Farther off there are only mere neighbours.
  const double limit = std::min(pair_distance * cloud.diagonal, reach(surface) * spacing);
  add_pairs(result, cloud, *result.mirror, limit, context.stage(0, 0.6));
  if (!surface.exact)
    result.surface_points = result.mirror->project(result.surface_points, context.stage(0.6, 1));
  drop_false_pairs(result, cloud, surface.exact, spacing);
}

// The voxels, in the search's frame and of an edge in its unit, that hold any of the points.
std::vector<Vector3> occupied_voxels(Points points, const SearchCloud& searched, double edge) {
  if (points.rows() == 0) return {};
  points = (points.rowwise() - searched.centroid.transpose()) * searched.axes / searched.diagonal;
  const VoxelGrid grid(points.colwise().minCoeff(), points.colwise().maxCoeff(), edge);
  std::vector<Index> voxels;
  for (Index k = 0; k < points.rows(); ++k)
    voxels.push_back(grid.index(grid.cell_of(points.row(k).transpose())));
  std::sort(voxels.begin(), voxels.end());
  voxels.erase(std::unique(voxels.begin(), voxels.end()), voxels.end());
  std::vector<Vector3> middles;
  for (const Index voxel : voxels)
    middles.push_back(searched.axes * grid.middle(grid.cell(voxel)) * searched.diagonal +
                      searched.centroid);
  return middles;
}

// How much of the mirror under the points is far from the feet of all pairs: it goes on there as it
// bends elsewhere, and nothing says that it is right. Points next to the mirror, whose neighbours
// are their images', are no evidence. By area: where one side is missing there are fewer points.
void tell_extrapolated(Result& result, const Cloud& cloud, const SearchCloud& searched,
                       const Context& context) {
  const double near = std::max(beyond, sparse * searched.spacing);
  const double next_to = std::max(close, sparse * searched.spacing) * searched.diagonal;
  std::vector<char> paired(cloud.points.size(), 0);
  std::vector<Index> evidence, others;
  for (Index row = 0; row < result.pairs.rows(); ++row) {
    const Index i = result.pairs(row, 0), j = result.pairs(row, 1);
    if ((cloud.points[i] - cloud.points[j]).norm() < next_to) continue;
    evidence.push_back(row);
    paired[i] = paired[j] = 1;
  }
  for (Index i = 0; i < cloud.points.size(); ++i)
    if (!paired[i]) others.push_back(i);
  const Points pairs = chosen_rows(result.surface_points, evidence);
  const Points feet =
      finite_rows(result.mirror->project(chosen_rows(cloud.points, others), context.stage(0, 0.7)));
  Points all(pairs.rows() + feet.rows(), 3);
  all << pairs, feet;
  const std::vector<Vector3> mirror =
      occupied_voxels(std::move(all), searched, voxels_within * near);
  const PointTree tree(pairs, context.stage(0.7, 1));
  const double squared = near * near * searched.diagonal * searched.diagonal;
  const auto far = std::count_if(mirror.begin(), mirror.end(), [&](const Vector3& x) {
    return tree.nearest(x, squared).index < 0;
  });
  const auto voxels = static_cast<double>(std::max<std::size_t>(1, mirror.size()));
  result.statistics["extrapolated_share"] = static_cast<double>(far) / voxels;
}

}  // namespace

std::shared_ptr<Mirror> in_input_units(const Mirror& mirror, const SearchCloud& searched) {
  return mirror.transformed(searched.diagonal, searched.axes, searched.centroid);
}

void fill(Result& result, const Cloud& cloud, const SearchCloud& searched,
          const std::vector<Found>& found, const ParameterValues& values, const Context& context) {
  if (found.empty()) return;
  const MirrorScore score(cloud, context.stage(0, 0.4));
  const auto most = 1 + static_cast<std::size_t>(values.integer("max_candidates"));
  std::vector<std::shared_ptr<Mirror>> mirrors;
  for (std::size_t k = 0; k < std::min(most, found.size()); ++k) mirrors.push_back(found[k].mirror);
  Values statistics = std::move(result.statistics);
  result = score.ranked(result.method, mirrors);
  const GrownSurface& surface =
      found[std::find(mirrors.begin(), mirrors.end(), result.mirror) - mirrors.begin()].surface;
  statistics["typical_miss"] = surface.typical_miss * searched.spacing * searched.diagonal;
  result.statistics.merge(statistics);
  if (!values.boolean("pairs")) return;
  pair_points(result, cloud, searched, surface, values.real("pair_distance"),
              context.stage(0.4, 0.9));
  tell_extrapolated(result, cloud, searched, context.stage(0.9, 1));
}

std::vector<Parameter> search_parameters() {
  return {
      Parameter::integer("sample_size", 12000, 200, 100000, "points",
                         "Number of points used by the search; larger clouds are downsampled."),
      max_candidates(10, 1000, "mirrors"),
      pair_distance(),
  };
}

namespace {

Result run_perpendicular(const Cloud& cloud, const ParameterValues& values,
                         const Context& context) {
  Search search =
      perpendicular::search(cloud, values.integer("sample_size"), context.stage(0, 0.7));
  Result result;
  result.method = "perpendicular";
  result.statistics["noise"] = search.cloud.noise * search.cloud.diagonal;
  std::vector<Found> found;
  for (GrownSurface& surface : search.surfaces) {
    std::shared_ptr<Mirror> mirror = in_input_units(*surface.mirror, search.cloud);
    found.push_back({std::move(mirror), std::move(surface)});
  }
  fill(result, cloud, search.cloud, found, values, context.stage(0.7, 1));
  return result;
}

}  // namespace

}  // namespace symsurf::perpendicular

namespace symsurf {

MethodImplementation perpendicular_method() {
  MethodImplementation method;
  method.name = "perpendicular";
  method.title = "Curved mirror, perpendicular mapping";
  method.summary =
      "Finds a curved mirror of any shape that maps points along its normals, by growing surfaces "
      "of oriented midpoints and by bending planes.";
  method.parameters = perpendicular::search_parameters();
  method.minimum_points = perpendicular::least_points;
  method.preprocessing.keep_interior = perpendicular::has_exact_partners;
  method.automatic = true;
  method.run = perpendicular::run_perpendicular;
  return method;
}

}  // namespace symsurf
