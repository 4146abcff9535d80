#pragma once

#include <symsurf/context.h>

#include <Eigen/Geometry>
#include <vector>

#include "base/parallel.h"
#include "fit/refinement.h"
#include "fit/shapes.h"
#include "score/mirror_score.h"

namespace symsurf {

/// What the search for a placement looks at of a shape, which must outlive it.
struct PlacedShape {
  PlacedShape(const Cloud& cloud, const Context& context);

  const PrincipalFrame& frame;
  const Surfels& coarse;
  SurfelMap map;
  NearestPoints points;
  Refinement refinement;
  MirrorScore score;
};

/// Lays one shape onto another: hypotheses from pairs of surfels (Drost et al., Model globally,
/// match locally, 2010), ranked and refined as mirrors are. Placements map the principal frame of
/// the first shape to that of the second; both frames are of one size.
class PlacementSearch {
 public:
  /// `reflected`: as a left bone is laid onto a right one.
  PlacementSearch(const PlacedShape& from, const PlacedShape& onto, bool reflected);

  /// The placement that scores most.
  UnitPlacement found(const Context& context) const;

  /// Of both shapes on each other.
  MirrorFit fit(const UnitPlacement& placement, Index stride) const;

  /// Whether it fits better than placements beside it, 0..1: the mean of both ways.
  double evidence(const UnitPlacement& placement) const;

  /// In "make accuracy" right placements have 0.42 at least (a third of both bones missing), shapes
  /// that are no pair 0.38 at most, except bones that differ by little more than the noise.
  static constexpr double least_evidence = 0.4;

 private:
  struct Chord;
  static std::vector<Index> flat_ones(const Surfels& surfels);
  std::vector<UnitPlacement> hypotheses(const Context& context) const;
  void add_laid_onto(const Chord& a, const Chord& b, std::vector<UnitPlacement>& all) const;

  const PlacedShape &from_, &onto_;
  double determinant_;  // of maps between the principal frames, which may be left-handed
};

/// A placement between two principal frames, in input units.
Matrix4 between_frames(const Eigen::Isometry3d& map, const PrincipalFrame& from,
                       const PrincipalFrame& onto);

}  // namespace symsurf
