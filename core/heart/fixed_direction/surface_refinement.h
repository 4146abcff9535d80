#pragma once

#include "cloud/surface_points.h"
#include "fixed_direction/field_search.h"
#include "fixed_direction/height_regression.h"
#include "fixed_direction/mid_surface.h"

namespace symsurf {

/// Mirror, match, fit again: images over the estimate meet the surfaces on the other side, half
/// their distance along the direction is what the surface is wrong by there. What remains across
/// determines how the direction turns.
class SurfaceRefinement {
 public:
  SurfaceRefinement(const SurfacePoints& cloud, const SurfacePatches& patches,
                    const Context& context);

  /// Starts from the surface that MidSurface votes for, where `scatter` (infinity: unknown) is that
  /// of partners across the direction.
  FieldEstimate operator()(const Vector3& direction, double scatter, int rounds);

 private:
  struct Matches {
    std::vector<HeightObservation> observations;
    Eigen::Vector2d turn = Eigen::Vector2d::Zero();  // that the matches ask of the direction
    double support = 0;
  };
  Matches matches(const FieldEstimate& estimate) const;
  void refit(FieldEstimate& estimate, Matches found) const;
  FieldEstimate voted(const Vector3& direction, double scatter);

  const SurfacePoints& cloud_;
  const SurfacePatches& patches_;
  const Context context_;
  MidSurface votes_;
};

}  // namespace symsurf
