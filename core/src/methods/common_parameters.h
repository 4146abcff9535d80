#pragma once

#include <symsurf/parameter.h>

#include <string>

// Parameters that several methods share: one description each.

namespace symsurf {

/// Of methods that search on surfels. `kind`: "the plane".
Parameter surfels_searched(Index usual, const std::string& kind);

/// `kinds`: "planes".
Parameter max_candidates(Index usual, Index most, const std::string& kinds);

Parameter pair_distance(double usual = 0.05);

/// Of methods that pair the points when the mirror is found; the registry adds it.
Parameter pairs();

/// Of all methods; the registry adds both.
Parameter minimum_score();
Parameter tolerance();

}  // namespace symsurf
