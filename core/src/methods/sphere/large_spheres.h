#pragma once

#include <vector>

#include "methods/parametric/refinement.h"
#include "methods/sphere/sphere_candidates.h"

namespace symsurf {

// Spheres so large that they may be planes. Each meets the plane that touches it where it is
// nearest to the cloud's middle, fitted in the same way.

/// Takes out of the candidates those that a plane explains as well, measured on surfels, and
/// returns the best few of them.
std::vector<SphereCandidate> take_planes(const Surfels& surfels, const SurfelMap& map,
                                         std::vector<SphereCandidate>& candidates);

/// Drops those that differ from a plane by rounding only.
void drop_flat(std::vector<SphereCandidate>& candidates);

/// Drops these, and those without partners that a plane explains as well, measured on points; all
/// but where there is nothing else. Through noise of 1 % half of the spheres are lost without it.
void drop_planes(const ParametricRefinement& refinement, std::vector<SphereCandidate>& candidates);

}  // namespace symsurf
