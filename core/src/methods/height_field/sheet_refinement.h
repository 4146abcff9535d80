#pragma once

#include <optional>

#include "methods/height_field/field_estimate.h"
#include "methods/height_field/height_regression.h"
#include "methods/height_field/mid_sheet.h"
#include "methods/height_field/sheet_patches.h"
#include "methods/height_field/sheet_rims.h"

namespace symsurf {

/// Mirror, match, fit again: images over the estimate meet the sheets on the other side, half
/// their distance along the direction is what the surface is wrong by there. Where partners are
/// known, what remains across tells where the direction should turn; where not, the rims do.
class SheetRefinement {
 public:
  SheetRefinement(const WorkingCloud& cloud, const SheetPatches& patches, const Context& context);

  /// Starts from the surface that MidSheet votes for, where `scatter` (infinity: unknown) is that
  /// of partners across the direction.
  FieldEstimate operator()(const Vector3& direction, double scatter, int rounds);

 private:
  struct Matches {
    std::vector<HeightObservation> observations;
    Eigen::Vector2d turn = Eigen::Vector2d::Zero();  // that the matches ask of the direction
    double explained = 0;
  };
  Matches matches(const FieldEstimate& estimate) const;
  void refit(FieldEstimate& estimate, Matches found) const;
  FieldEstimate voted(const Vector3& direction, double scatter);

  const WorkingCloud& cloud_;
  const SheetPatches& patches_;
  const Context context_;
  std::optional<SheetRims> rims_;  // where no partners tell the direction
  Vector3 start_ = Vector3::Zero();
  MidSheet votes_;
};

}  // namespace symsurf
