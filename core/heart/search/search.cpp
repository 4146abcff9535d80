#include "search/search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <utility>

#include "search/growth.h"
#include "search/plane_bending.h"

namespace symsurf::perpendicular {

namespace {

constexpr std::size_t most_trials = 20, most_surfaces = 4;  // of either kind of seed
constexpr Index trial_points = 60;
constexpr int trial_refinements = 2, first_rounds = 2;
constexpr std::array<double, 3> seed_distances{12, 6, 3};  // spacings, the least between seeds
constexpr double least_support = 0.3;
constexpr double same_direction = 0.9;
constexpr double least_expected = 0.4;  // of the best support
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
  std::vector<Growth> growths;
  for (const Seed& seed : spread_out(cloud, seeds, most)) {
    Growth growth(cloud, seed);
    growth.grow(trial_points);
    if (static_cast<Index>(growth.accepted().size()) < trial_points / 2) continue;
    for (int k = 0; k < trial_refinements; ++k) growth.refine();
    growths.push_back(std::move(growth));
  }
  std::stable_sort(growths.begin(), growths.end(),
                   [](const Growth& a, const Growth& b) { return a.closeness() > b.closeness(); });
  return growths;
}

double most_support(const std::vector<GrownSurface>& surfaces) {
  double most = 0;
  for (const GrownSurface& surface : surfaces) most = std::max(most, surface.support);
  return most;
}

// Adds the surfaces grown from trials, each from one that no surface before mirrors, and refines
// those that may come near the best support so far. In the order found. Gives up where the first
// stays far behind a support that others have.
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
    // Refining a surface that mirrors far fewer points than the best does not change the result.
    const double expected = growth.closeness() * static_cast<double>(growth.accepted().size()) /
                            static_cast<double>(cloud.size());
    if (++grown > most_surfaces) break;
    if (expected < least_expected * best) continue;
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
  explore(search.cloud, std::move(across), others, search.surfaces, context.stage(0.8, 0.85));
  std::move(bent.begin(), bent.end(), std::back_inserter(search.surfaces));
  refine_best(search.cloud, search.surfaces, context.stage(0.85, 1));
  return search;
}

bool has_exact_partners(const Cloud& cloud, const ParameterValues& values, const Context& context) {
  const SearchCloud all(cloud, values.integer("sample_size"), context);
  return has_exact_partners(all, find_seeds(all, cloud.seed, context));
}

}  // namespace symsurf::perpendicular
