#pragma once

#include <vector>

#include "cloud/surfel_map.h"
#include "cloud/surfels.h"
#include "methods/parametric/unit_plane.h"

namespace symsurf {

/// A plane and what speaks for it: the share of the cloud that it explains, less what contradicts
/// it.
struct PlaneCandidate {
  UnitPlane plane;
  double support = 0;
};

/// Share of the surfels whose images agree with the cloud, less some of those whose images come
/// beside it, out of those the plane moves (at least 35 % of all, so that a plane the cloud lies
/// along explains nothing). An image in the void says nothing: that part may be missing. `stride` k
/// looks at every k-th surfel.
double support_share(const Surfels& surfels, const SurfelMap& map, const UnitPlane& plane,
                     double tolerance, Index stride = 1);

/// How much to try, on a thousand surfels or more. Of fewer, which lie further from their partners,
/// fewer pairs come near a plane, and more are tried.
struct Search {
  Index seeds;       ///< surfels that pairs are made of
  double pairs;      ///< whose planes are glanced at
  double promising;  ///< of these, that are looked at and averaged with the like
  double averages;   ///< that are looked at again
};
inline constexpr Search usual_search{200, 3000, 800, 150};

/// Planes between pairs of surfels whose normals mirror each other, similar ones averaged, the
/// best `count` first.
std::vector<PlaneCandidate> candidate_planes(const Surfels& surfels, const SurfelMap& map,
                                             const Search& search, Index count);

/// Moves a plane onto the surfels' images, looking less far with each step.
PlaneCandidate refined_on_surfels(const Surfels& surfels, const SurfelMap& map,
                                  PlaneCandidate candidate, double widest, double narrowest,
                                  int steps, Index stride);

/// Drops planes that mirror the cloud nearly as a better one does; best first.
void suppress_non_maxima(std::vector<PlaneCandidate>& candidates, double distance, Index count);

}  // namespace symsurf
