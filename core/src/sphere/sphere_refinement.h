#pragma once

#include <symsurf/method.h>

#include <vector>

#include "../plane/surfels.h"
#include "../point_tree.h"
#include "sphere_candidates.h"

namespace symsurf {

/// Fits spheres to the full cloud: samples of it are mirrored and meet the nearest of all points.
class SphereRefinement {
 public:
  SphereRefinement(const Cloud& cloud, const PointTree& tree, const Surfels& surfels);

  /// The sphere that leaves the least robust residual on about `wanted` samples.
  SphereCandidate fitted(const SphereCandidate& start, Index wanted, int steps) const;

  /// Where the same points stand on both sides, converges on them to rounding; otherwise `start`.
  SphereCandidate fitted_to_exact_pairs(const SphereCandidate& start) const;

  /// Of the samples the sphere moves, the share that meets the cloud.
  double explained(const UnitSphere& sphere, Index wanted) const;

  /// What a perfect mirror would explain: the share of the samples that their own nearest
  /// neighbours explain. Below 1 where the cloud is sparse, noisy or strongly curved.
  double self_explained() const;

 private:
  struct Sample {
    Vector3 position;
    const Surfel* surfel;
  };
  struct Match {
    const Sample* sample;
    Vector3 gap;  // from the partner to the image
    const Surfel* partner;
  };

  Index stride_for(Index wanted) const;
  std::vector<Match> matches(const UnitSphere& sphere, double limit, Index stride) const;

  const Cloud& cloud_;
  const PointTree& tree_;
  const Surfels& surfels_;
  double spacing_;
  std::vector<Sample> samples_;
};

}  // namespace symsurf
