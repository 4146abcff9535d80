#pragma once

#include <symsurf/points.h>

#include <vector>

#include "cloud/surface_points.h"

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

}  // namespace symsurf
