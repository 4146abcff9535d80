#pragma once

#include <vector>

#include "methods/parametric/refinement.h"
#include "methods/sphere/sphere_candidates.h"
#include "score/mirror_score.h"

namespace symsurf {

// Spheres so large that they may be planes. Each meets the plane that touches it where it is
// nearest to the cloud's middle, fitted in the same way.

/// Takes out of the candidates those that a plane explains as well, measured on surfels, and
/// returns the best few of them.
std::vector<SphereCandidate> take_planes(const Surfels& surfels, const SurfelMap& map,
                                         std::vector<SphereCandidate>& candidates);

/// Drops those without partners that a plane explains as well, measured on points; all but where
/// there is nothing else. Those that differ from a plane by rounding only go in any case.
void drop_planes(const Refinement& refinement, std::vector<SphereCandidate>& candidates);

/// The same by the score, with partners or without.
void drop_planes(const Refinement& refinement, const MirrorScore& score,
                 const PrincipalFrame& frame, std::vector<SphereCandidate>& candidates);

}  // namespace symsurf
