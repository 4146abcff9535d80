#pragma once

#include <symsurf/points.h>

#include <vector>

#include "methods/free_form/search_cloud.h"

namespace symsurf::perpendicular {

/// Two points that may mirror each other, and how well their surroundings do (0 to 1).
struct Seed {
  std::int32_t first, second;
  double support = 0;
};

/// Pairs whose normals mirror each other about the plane that bisects them, best supported first:
/// the neighbours of one end, mirrored over that plane, should land on the cloud.
struct Seeds {
  std::vector<Seed> along;   ///< chords about along the normals: two surfaces face each other
  std::vector<Seed> across;  ///< the others: far more, and most of them by chance
};

Seeds find_seeds(const SearchCloud& cloud, std::uint64_t seed, const Context& context);

}  // namespace symsurf::perpendicular
