#pragma once

#include <vector>

#include "cloud/principal_frame.h"
#include "cloud/surfels.h"
#include "fit/candidate.h"

namespace symsurf {

using PlaneCandidate = Candidate<UnitPlane>;

/// How much a surfel's image beside the cloud counts against a plane: for support_share().
inline constexpr double contradiction = 0.9;

/// Planes between pairs of surfels whose normals mirror each other, the best `count` that
/// differ first.
std::vector<PlaneCandidate> candidate_planes(const Surfels& surfels, const SurfelMap& map,
                                             Index count);

/// Drops planes that mirror the cloud nearly as a better one does; best first.
void suppress_non_maxima(std::vector<PlaneCandidate>& candidates, double distance, Index count);

}  // namespace symsurf
