#pragma once

#include <vector>

#include "../plane/surfel_map.h"
#include "../plane/surfels.h"
#include "unit_sphere.h"

namespace symsurf {

/// A sphere and the share of the surfels that it explains, in [0, 1].
struct SphereCandidate {
  UnitSphere sphere;
  double explained = 0;
};

/// Share of the surfels whose images agree with the cloud, out of those the sphere moves (at least
/// 35 % of all, so that a sphere the cloud lies along explains nothing). Surfels without an image
/// count as moved. `stride` k looks at every k-th surfel.
double explained_share(const Surfels& surfels, const SurfelMap& map, const UnitSphere& sphere,
                       double tolerance, Index stride = 1);

/// Spheres that mirror a pair of surfels onto each other, normals included. A pair fixes a point
/// and the normal of the sphere there; the curvature is scanned. The best `count` that differ.
std::vector<SphereCandidate> candidate_spheres(const Surfels& surfels, const SurfelMap& map,
                                               std::uint64_t seed, Index count);

/// Moves a sphere onto the surfels' images, looking less far with each step.
SphereCandidate settled(const Surfels& surfels, const SurfelMap& map, SphereCandidate candidate,
                        double widest, double narrowest, int steps, Index stride);

/// Drops spheres that mirror the cloud nearly as a better one does; best first.
void keep_distinct(const Surfels& surfels, std::vector<SphereCandidate>& candidates,
                   double distance, Index count);

}  // namespace symsurf
