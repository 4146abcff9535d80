#pragma once

#include <vector>

#include "cloud/cloud.h"
#include "cloud/point_tree.h"
#include "fit/candidate.h"
#include "fit/shapes.h"

namespace symsurf {

using SphereCandidate = Candidate<UnitSphere>;

/// Fits spheres where the same points stand on both sides. A surface that slides along itself holds
/// a sphere loosely, partners hold it firmly: the sphere passes through the midpoint m of a point
/// and its partner, its normal u there along their line, so that two of them give the curvature k
/// and whether they agree, u1 - u2 = k (m1 - m2). Partners are sought among the points near the
/// images.
class PartnerFit {
 public:
  /// The spacing of the points, in the principal frame.
  PartnerFit(const Cloud& cloud, const NearestPoints& points, const PointTree& tree, double spacing,
             const Context& context);

  /// The candidate on its partners, `partnered` the share that have some beyond chance; as it
  /// was where points have no partners.
  SphereCandidate operator()(const SphereCandidate& start) const;

  /// The same sphere on up to `most` of the points, to rounding where partners are exact.
  UnitSphere refined(const UnitSphere& sphere, Index most) const;

  /// The points, in input units, whose images have no point near them.
  Points unpaired_points(const UnitSphere& sphere) const;

 private:
  /// A point and one that may be its partner.
  struct Chord {
    Vector3 middle, along;  // along: as the sphere's normal
  };

  std::vector<std::vector<Chord>> chords(const UnitSphere& sphere) const;
  std::vector<Vector3> positions(Index wanted) const;
  double paired_share(const UnitSphere& sphere, Index wanted) const;

  const Cloud& cloud_;
  const NearestPoints& points_;
  const PointTree& tree_;
  double spacing_;
  const Context context_;
};

}  // namespace symsurf
