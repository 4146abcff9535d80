#pragma once

#include <vector>

#include "fit/candidate.h"
#include "fit/refinement.h"
#include "fit/shapes.h"
#include "score/mirror_score.h"

namespace symsurf {

using SphereCandidate = Candidate<UnitSphere>;

/// Spheres closer than this are one, for suppress_non_maxima.
constexpr double alike_spheres = 0.04;

/// The best `count` spheres that differ, on the thinned cloud alone: from pairs of surfels, of any
/// radius, refined on the surfels. Behind them
/// the best of those that fit the surfels no better than a plane.
std::vector<SphereCandidate> promising_spheres(const Surfels& surfels, const SurfelMap& map,
                                               std::uint64_t seed, Index count,
                                               const Context& context);

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
