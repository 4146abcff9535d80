#pragma once

#include "methods/height_field/chord_histogram.h"
#include "methods/height_field/mid_surface.h"

namespace symsurf {

/// A direction of mapping and how it was judged.
struct DirectionCandidate {
  Vector3 direction;
  double support = 0;  ///< MidSurface::support
};

/// Directions under which a surface half-way between the surfaces explains most of the cloud, best
/// first, some degrees apart: the half sphere and the given hints are tried, as far as
/// MidSurface::most_explained leaves hope, on fewer points, then the best of them are moved uphill
/// on all.
std::vector<DirectionCandidate> explaining_directions(const WorkingCloud& cloud,
                                                      const std::vector<ChordPeak>& hints,
                                                      Index count, const Context& context);

/// The i-th of `count` directions spread evenly over the half sphere: a Fibonacci spiral.
Vector3 spread_direction(Index i, Index count);

}  // namespace symsurf
