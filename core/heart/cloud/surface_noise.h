#pragma once

#include <vector>

#include "cloud/nearest_points.h"
#include "cloud/surfels.h"

namespace symsurf {

/// A point of a cloud and the patch of its surface, in the principal frame.
struct OnSurface {
  Vector3 position;
  const Surfel* surfel;
};

/// The points nearest but one to them, in the principal frame.
std::vector<Vector3> neighbours_of(const std::vector<OnSurface>& samples,
                                   const PrincipalFrame& frame, const NearestPoints& points);

/// The noise that takes a cloud's points off its surfaces, and points without it.
class SurfaceNoise {
 public:
  SurfaceNoise() = default;

  /// From how far neighbours lie off the samples' surfaces; none where there are no samples. Being
  /// near, they have much of their noise in common.
  SurfaceNoise(const std::vector<OnSurface>& samples, const std::vector<Vector3>& neighbours);

  /// Standard deviation, over the cloud's size.
  double deviation() const { return deviation_; }

  /// Is it more than what curvature between neighbours makes?
  bool shows() const;

  /// Where noise shows, x moved onto what its patch has in common. What spreads little more than
  /// the noise, as small patches do across their surface, is taken for noise as well.
  Vector3 smoothed(const Vector3& x, const Surfel& patch) const;

 private:
  double deviation_ = 0;
};

}  // namespace symsurf
