#pragma once

#include <vector>

#include "methods/parametric/candidate.h"
#include "methods/parametric/unit_cylinder.h"

namespace symsurf {

using CylinderCandidate = Candidate<UnitCylinder>;

/// Cylinders that mirror a pair of surfels onto each other, normals included. A pair fixes a point
/// and the normal of the cylinder there; curvature and direction of the axis are scanned. The best
/// `count` that differ.
std::vector<CylinderCandidate> candidate_cylinders(const Surfels& surfels, const SurfelMap& map,
                                                   std::uint64_t seed, Index count,
                                                   const Context& context);

}  // namespace symsurf
