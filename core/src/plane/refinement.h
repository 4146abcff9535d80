#pragma once

#include <symsurf/method.h>

#include <cstdint>
#include <vector>

#include "../point_tree.h"
#include "agreement.h"
#include "candidates.h"
#include "surfels.h"

namespace symsurf {

/// Fits planes to the full cloud: samples of it are mirrored and meet the nearest of all points.
class Refinement {
 public:
  /// `scales`: surfels that give the normals; at each place the flattest do.
  Refinement(const Cloud& cloud, const PointTree& tree, std::vector<const Surfels*> scales);

  /// The plane after a few steps on a few samples, with what then speaks for it.
  PlaneCandidate quick(const PlaneCandidate& start) const;

  /// The same on enough samples to rank planes.
  PlaneCandidate careful(const PlaneCandidate& start) const;

  /// The same on all samples. Where partners are exact, it converges to rounding.
  PlaneCandidate final(const PlaneCandidate& start) const;

  /// The share of the samples whose images meet the cloud.
  double explained_share(const UnitPlane& plane) const;

  /// What a perfect mirror would explain: the share of the samples that their own nearest
  /// neighbours explain. Below 1 where the cloud is sparse, noisy or strongly curved.
  double self_explained() const;

 private:
  // Every `stride`-th of the samples before `end`.
  struct Subset {
    Index end, stride;
  };
  enum class Merit { Testimony, Closeness };
  struct Match {
    Index sample;
    Vector3 partner;
    const Surfel* surfel;  // the partner's
  };
  struct Sample {
    Vector3 position;
    const Surfel* surfel;
    std::uint32_t place;  // along a curve that fills space
  };

  Subset about(Index wanted) const;
  Subset all() const;
  double residual(const Vector3& gap, const Surfel& partner) const;
  PlaneCandidate rated(const UnitPlane& plane) const;
  const Surfel* surfel_at(const Vector3& x) const;

  std::array<Neighbour, PointTree::block> nearest(const PointTree::Queries& images, double limit,
                                                  Index& near) const;
  std::vector<Match> matches(const UnitPlane& plane, double limit, Subset subset) const;
  double explained(const UnitPlane& plane, const std::vector<Match>& found, Subset subset,
                   Merit merit) const;
  // `found`: the plane's partners, where they are known.
  UnitPlane fitted(UnitPlane plane, double tolerance, Subset subset, int steps,
                   std::vector<Match> found = {}) const;
  UnitPlane fitted_to_exact_pairs(const UnitPlane& start) const;

  const Cloud& cloud_;
  const PointTree& tree_;
  std::vector<const Surfels*> scales_;
  double spacing_;  // of the points on a sheet
  std::vector<Sample> samples_;
  Index even_samples_ = 0;  // the first ones, spread evenly over the cloud
};

}  // namespace symsurf
