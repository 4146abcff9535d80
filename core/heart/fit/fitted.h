#pragma once

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "base/math.h"
#include "cloud/surfels.h"
#include "fit/gauss_newton.h"

namespace symsurf {

/// A point, its image's partner on the cloud, and the surface at both. `map`: the number of the map
/// that has the image.
struct Match {
  Vector3 point;
  Facet facet;
  Vector3 partner;
  Facet partner_facet;
  std::size_t map = 0;
};

/// How far off partners may be at first and at last, in diagonals, and how many steps a fit takes.
struct Schedule {
  double widest, narrowest;
  int steps;
};

/// Maps that share their numbers, as elements of a group in one pose do, or a single one, moved
/// until the shape lies on itself: reweighted least squares. The tolerance follows the residuals of
/// what it lets in, down to what the schedule ends with: images that only just miss the cloud, at
/// the edge of a hole or where nothing mirrors them, stop pulling. Looking for partners is most of
/// the work: they stay until the maps have moved by a part of the spacing, or have converged
/// between them.
///
/// `Matcher`: matches(maps, limit) has partners no farther off than the limit, spacing() is that of
/// what they are among, along_surface() how much an offset along it counts, as partners hardly hold
/// a map where they may slide.
template <typename Map, typename Matcher>
std::vector<Map> fitted(std::vector<Map> maps, const Matcher& matcher, const Schedule& schedule) {
  constexpr double reach = 0.06, widening = 2, still = 1e-4;
  const double spacing = matcher.spacing(), stale = 0.1 * spacing, converged = 0.02 * spacing;
  double tolerance = schedule.widest, moved = infinity;
  std::vector<Match> found;
  for (int step = 0; step < schedule.steps; ++step) {
    if (moved > stale) {
      found = matcher.matches(maps, std::min(reach, 4 * tolerance + spacing));
      moved = 0;
    }
    GaussNewton<Map> sum;
    double squares = 0, weights = 0;
    for (const Match& match : found) {
      const Map& map = maps[match.map];
      const Vector3& x = match.point;
      const double weight = displaced(map.distance(x), tolerance);
      if (weight <= 0) continue;
      const Vector3 off = map.reflect(x) - match.partner;
      if (!off.allFinite()) continue;  // the map has moved since
      const Facet& facet = match.partner_facet;
      const Correspondence correspondence(off, map.reflect_direction(x, match.facet.normal),
                                          match.facet.flatness, facet);
      const double r = distance_past(off, facet, spacing) / tolerance;
      const double trusted = weight * correspondence.normal_consistency *
                             inside_surface(off, facet, spacing) * fading(r * r / 2);
      squares += trusted * r * r;
      weights += trusted;
      sum.add(map, x, off, correspondence.metric(matcher.along_surface()), trusted);
    }
    if (weights < 4) break;
    const auto [next, change] = sum.taken(maps.front());
    for (Map& map : maps) map.follow(next);
    moved += change;
    tolerance = std::clamp(widening * tolerance * std::sqrt(squares / weights), schedule.narrowest,
                           tolerance);
    if (change < still) {
      if (moved < converged) break;
      moved = infinity;
    }
  }
  return maps;
}

/// A single map.
template <typename Map, typename Matcher>
Map fitted(const Map& map, const Matcher& matcher, const Schedule& schedule) {
  return fitted(std::vector<Map>{map}, matcher, schedule).front();
}

}  // namespace symsurf
