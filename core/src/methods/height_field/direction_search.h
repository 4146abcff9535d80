#pragma once

#include "methods/height_field/chord_histogram.h"
#include "methods/height_field/mid_surface.h"

namespace symsurf {

/// A direction of mapping and how it was judged.
struct DirectionCandidate {
  Vector3 direction;
  double support = 0;  ///< MidSurface::support
};

/// Directions under which a surface half-way between the surfaces has most support, best
/// first, some degrees apart: the half sphere and the given hints are tried, as far as
/// MidSurface::support_bound allows, on fewer points, then the best of them are moved uphill
/// on all.
std::vector<DirectionCandidate> supported_directions(const SurfacePoints& cloud,
                                                     const std::vector<ChordPeak>& hints,
                                                     Index count, const Context& context);

}  // namespace symsurf
