#pragma once

#include <vector>

#include "cloud/surfels.h"
#include "spatial/nearest_points.h"

namespace symsurf {

/// A point of a cloud and the patch of its sheet, in the principal frame.
struct OnSheet {
  Vector3 position;
  const Surfel* surfel;
};

/// The points nearest but one to them, in the principal frame. Collective.
std::vector<Vector3> neighbours_of(const std::vector<OnSheet>& samples, const PrincipalFrame& frame,
                                   const NearestPoints& points);

/// The noise that takes a cloud's points off its sheets, and points without it.
class SheetNoise {
 public:
  SheetNoise() = default;

  /// From how far neighbours lie off the samples' sheets; none where there are no samples. Being
  /// near, they have much of their noise in common.
  SheetNoise(const std::vector<OnSheet>& samples, const std::vector<Vector3>& neighbours);

  /// Standard deviation, over the cloud's size.
  double deviation() const { return deviation_; }

  /// Is it more than what curvature between neighbours makes?
  bool shows() const;

  /// Where noise shows, x moved onto what its patch has in common. What spreads little more than
  /// the noise, as small patches do across their sheet, is taken for noise as well.
  Vector3 smoothed(const Vector3& x, const Surfel& patch) const;

 private:
  double deviation_ = 0;
};

}  // namespace symsurf
