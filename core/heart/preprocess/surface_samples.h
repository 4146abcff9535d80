#pragma once

#include <vector>

#include "preprocess/preprocessing.h"

namespace symsurf {

/// A point of a face: its first corner, from there `down` of the way to the point `along` the
/// opposite side.
struct FaceSample {
  Index face;
  double down, along;
};

/// About `count` of them, one of a low-discrepancy sequence in each equal share of the faces'
/// areas.
std::vector<FaceSample> even_face_samples(const std::vector<double>& areas, Index count);

/// Even sampling of a triangle mesh by area: one point of a low-discrepancy sequence an equal share
/// of the area of the faces in their order. Where planes map the mesh onto itself the samples of
/// their one side are the images of those of the other, over up to three planes at right angles:
/// whatever matches samples finds exact partners. The samples become the cloud's points, its points
/// the vertices, used by a face or not. No samples where many vertices lie evenly as they are. The
/// pairs of the result are then those of the vertices.
class SurfaceSamples : public Stage {
 public:
  bool apply(Cloud& cloud, const Context& context) override;
  void map_back(Result& result, PairDistance pair_distance, const Context& context) const override;

 private:
  std::shared_ptr<const Cloud> vertices_;
  Index count_ = 0;
};

}  // namespace symsurf
