#pragma once

#include <symsurf/points.h>

#include <vector>

#include "cloud/surface_points.h"
#include "fixed_direction/mid_surface.h"

namespace symsurf {

/// A direction that more chords of the cloud share than its surroundings let expect.
struct ChordPeak {
  Vector3 direction;
  double significance;  ///< in standard deviations of a Poisson count
};

/// Peaks of the directions of the chords between points, best first.
///
/// The directions fall into the bins of a cube map; a chord counts as it crosses the surfaces at
/// its ends, cos x cos, since chords within a surface show no direction of mapping. Box sums at
/// several scales are held against the ring around them.
std::vector<ChordPeak> chord_peaks(const SurfacePoints& cloud, Index count, const Context& context);

/// The direction about `start` on which most chords agree, found by halving a cone as long as
/// its core keeps more than its share of the chords.
struct SharpDirection {
  Vector3 direction;
  double angle = 0;     ///< of the last cone, radians
  Index chords = 0;     ///< in it
  double expected = 0;  ///< chords in it, were they spread evenly over the first cone
};
SharpDirection sharpened(const SurfacePoints& cloud, const Vector3& start, double angle);

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
