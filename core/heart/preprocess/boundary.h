#pragma once

#include <vector>

#include "cloud/cloud.h"
#include "preprocess/preprocessing.h"

namespace symsurf {

/// Whether the points fill bodies, as the voxels of a mask do, rather than lie on surfaces.
bool is_volumetric(const Cloud& cloud, const Context& context);

/// The points of a volumetric cloud that have others on one side only, ascending.
std::vector<Index> boundary_of(const Cloud& cloud, const Context& context);

/// Extraction of the boundary of a volumetric cloud, the only part that defines a mirror.
/// The image of an inner point mostly lies inside, wherever the mirror is. The pairs of the result
/// are then those of all points.
class BoundaryExtraction : public Stage {
 public:
  /// The values of the method's parameters, which keep_interior gets, must outlive the stage.
  BoundaryExtraction(Index minimum_points, decltype(Preprocessing::keep_interior) keep_interior,
                     const ParameterValues& values)
      : minimum_points_(minimum_points), keep_interior_(keep_interior), values_(values) {}

  /// Of a volumetric cloud.
  bool apply(Cloud& cloud, const Context& context) override;
  void map_back(Result& result, PairDistance pair_distance, const Context& context) const override;

 private:
  Index minimum_points_;
  decltype(Preprocessing::keep_interior) keep_interior_;
  const ParameterValues& values_;
  Cloud whole_;
  Index count_ = 0;
};

}  // namespace symsurf
