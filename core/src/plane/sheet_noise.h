#pragma once

#include <vector>

#include "surfels.h"

namespace symsurf {

/// The noise that takes a cloud's points off its sheets, and points without it.
class SheetNoise {
 public:
  SheetNoise() = default;

  /// From how far neighbours of at least one sample lie off its sheet. Being near, they have much
  /// of their noise in common.
  explicit SheetNoise(std::vector<double> offsets);

  /// Where the neighbours show noise, at least as much of it as the thin ones among patches have:
  /// of dense clouds neighbours are so near that they have most of it in common.
  SheetNoise(std::vector<double> offsets, const Surfels& patches);

  /// Standard deviation, over the cloud's size.
  double deviation() const { return deviation_; }

  /// Is it more than what curvature between neighbours makes?
  bool shows() const;

  /// Is the patch no thicker than one sheet with the noise?
  bool explains(const Surfel& patch) const;

  /// Where noise shows, x moved onto what its patch has in common. What spreads little more than
  /// the noise, as small patches do across their sheet, is taken for noise as well.
  Vector3 smoothed(const Vector3& x, const Surfel& patch) const;

 private:
  double deviation_ = 0;
};

}  // namespace symsurf
