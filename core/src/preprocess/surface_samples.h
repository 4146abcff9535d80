#pragma once

#include "preprocess/preprocessing.h"

namespace symsurf {

/// Even sampling of a triangle mesh: a lattice of points on every face larger than its spacing.
/// The cloud's points become the vertices, used by a face or not, followed by the samples; its
/// faces are used up. Mirrored faces get mirrored samples; two faces that make up a rectangle get
/// the same grid whichever diagonal divides it. No samples where all faces are smaller, or many
/// vertices lie evenly as they are. The pairs of the result are then those of the vertices.
class SurfaceSamples : public Stage {
 public:
  bool apply(Cloud& cloud, const Context& context) override;
  void map_back(Result& result, double pair_distance, const Context& context) const override;

 private:
  PointsView vertices_;
  double diagonal_ = 0;
  Index count_ = 0;
};

}  // namespace symsurf
