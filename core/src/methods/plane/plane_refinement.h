#pragma once

#include <cstdint>
#include <vector>

#include "cloud/cloud.h"
#include "cloud/surface_noise.h"
#include "cloud/surfels.h"
#include "methods/plane/plane_candidates.h"
#include "score/correspondence.h"
#include "spatial/nearest_points.h"

namespace symsurf {

/// Fits planes to the full cloud: samples of it are mirrored and meet the nearest of all points.
class Refinement {
 public:
  /// The surfels give the normals, at each position the flattest.
  Refinement(const Cloud& cloud, const NearestPoints& points, const Surfels& coarse,
             const Surfels& fine);

  /// The plane after a few steps on a few samples, with its support.
  PlaneCandidate quick(const UnitPlane& start) const;

  /// The same on more samples.
  PlaneCandidate careful(const UnitPlane& start) const;

  /// The plane fitted to all samples. Where partners are exact, it converges to rounding.
  UnitPlane refined(const UnitPlane& start) const;

  /// The plane of points that have exact partners over it; `start` where there are none.
  UnitPlane exact(const UnitPlane& start) const;

 private:
  struct Match {
    Index sample;
    Vector3 partner;
    const Surfel* surfel;  // the partner's
  };
  struct Sample {
    Vector3 point;
    const Surfel* surfel;
    std::uint32_t position;    // along a curve that fills space
    Vector3 smoothed = point;  // less its noise
  };

  // The stride between samples, for about so many.
  Index stride_for(Index wanted) const;
  SurfaceNoise measured_noise() const;
  Vector3 smoothed_gap(const UnitPlane& plane, const Match& match) const;
  PlaneCandidate rated(const UnitPlane& plane, Index stride) const;
  const Surfel* surfel_at(const Vector3& x) const { return flattest_at({&coarse_, &fine_}, x); }

  std::vector<Match> matches(const UnitPlane& plane, double limit, Index stride) const;
  double support(const UnitPlane& plane, Index stride) const;
  UnitPlane fitted(UnitPlane plane, double tolerance, Index stride, int steps) const;

  const Cloud& cloud_;
  const NearestPoints& points_;
  const Surfels &coarse_, &fine_;
  double spacing_;  // of the points on a surface
  SurfaceNoise noise_;
  NearMissKernel kernel_;
  std::vector<Sample> samples_;  // spread evenly over the cloud
};

}  // namespace symsurf
