#pragma once

#include "plane/sheet_noise.h"
#include "plane/surfels.h"

namespace symsurf {

/// A point of a sheet, and how far it may be off it; over the cloud's size.
struct Located {
  Vector3 place;
  double uncertain = 0;
};

/// What becomes of the noise of points.
enum class NoiseIs {
  kept,
  /// Less by what a patch's points have in common. A patch's plane lies inside of what is curved:
  /// a plane mirrors that as well.
  smoothed,
  /// What patches of two sizes say is extrapolated to a patch of no size (Richardson 1911), which
  /// is curved as the sheet is.
  extrapolated
};

/// Where points lie on the sheets of a cloud in whose neighbours that noise shows.
class SheetPlaces {
 public:
  /// The patches must outlive the places.
  SheetPlaces(const Surfels& coarse, const Surfels& fine, const SheetNoise& noise, Index points);

  Located at(const Vector3& x, NoiseIs noise) const;

 private:
  Located smoothed(const Vector3& x) const;
  Located extrapolated(const Vector3& x) const;

  const Surfels *coarse_, *fine_;
  SheetNoise noise_;
  double left_;  // of the noise, where patches average it
};

}  // namespace symsurf
