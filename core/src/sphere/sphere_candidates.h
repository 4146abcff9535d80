#pragma once

#include <vector>

#include "../parametric/candidate.h"
#include "unit_sphere.h"

namespace symsurf {

using SphereCandidate = Candidate<UnitSphere>;

/// Spheres that mirror a pair of surfels onto each other, normals included. A pair fixes a point
/// and the normal of the sphere there; the curvature is scanned. The best `count` that differ.
std::vector<SphereCandidate> candidate_spheres(const Surfels& surfels, const SurfelMap& map,
                                               std::uint64_t seed, Index count,
                                               const Context& context);

}  // namespace symsurf
