#include "methods/free_form/exploration.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "methods/free_form/growth.h"

namespace symsurf::perpendicular {

namespace {

constexpr std::size_t most_trials = 20, most_surfaces = 4;  // of either kind of seed
constexpr Index trial_points = 60;
constexpr int settlings = 2, first_rounds = 2;
constexpr std::array<double, 3> same_place{12, 6, 3};  // spacings
constexpr double least_support = 0.3;
constexpr double same_direction = 0.9;
constexpr double far_below_best = 0.4, convincing = 0.85;

// Seeds to try: the best supported first, but far from each other before they crowd.
std::vector<Seed> spread_out(const SearchCloud& cloud, const std::vector<Seed>& seeds,
                             std::size_t most) {
  struct Position {
    Vector3 middle, direction;
  };
  std::vector<Position> positions;
  std::vector<Seed> chosen;
  for (const double spacings : same_place) {
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

}  // namespace

std::vector<Growth> trials(const SearchCloud& cloud, const std::vector<Seed>& seeds,
                           std::size_t most) {
  std::vector<Growth> growths;
  for (const Seed& seed : spread_out(cloud, seeds, most)) {
    Growth growth(cloud, seed);
    growth.grow(trial_points);
    if (static_cast<Index>(growth.accepted().size()) < trial_points / 2) continue;
    for (int k = 0; k < settlings; ++k) growth.settle();
    growths.push_back(std::move(growth));
  }
  std::stable_sort(growths.begin(), growths.end(),
                   [](const Growth& a, const Growth& b) { return a.closeness() > b.closeness(); });
  return growths;
}

void explore(const SearchCloud& cloud, const std::vector<Seed>& seeds,
             std::vector<GrownSurface>& surfaces, const Context& context) {
  double best = 0;
  for (const GrownSurface& surface : surfaces) best = std::max(best, surface.support);
  std::size_t grown = 0;
  for (Growth& growth : trials(cloud, seeds, most_trials)) {
    context.report(static_cast<double>(grown) / most_surfaces);
    if (std::any_of(surfaces.begin(), surfaces.end(),
                    [&](const GrownSurface& surface) { return known(cloud, growth, surface); }))
      continue;
    growth.grow(cloud.size());
    // What has grown says about what refining can give; far below the best it is not worth it.
    const double promise = growth.closeness() * static_cast<double>(growth.accepted().size()) /
                           static_cast<double>(cloud.size());
    if (++grown > most_surfaces) break;
    if (promise < far_below_best * best) continue;
    GrownSurface surface;
    for (const std::int32_t i : growth.accepted()) surface.carried.push_back(growth.carried(i));
    refine(cloud, first_rounds, surface);
    if (!surface.mirror) continue;
    best = std::max(best, surface.support);
    const bool enough = surface.support > convincing && !is_flat(surface);
    surfaces.push_back(std::move(surface));
    if (enough) break;
  }
}

}  // namespace symsurf::perpendicular
