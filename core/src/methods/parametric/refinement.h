#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <vector>

#include "cloud/unit_plane.h"
#include "methods/parametric/candidate.h"
#include "methods/parametric/plane_bend.h"
#include "spatial/nearest_points.h"

namespace symsurf {

/// Fits mirrors of few numbers, the shapes of shapes.h, to the full cloud: samples of it are
/// mirrored and meet the nearest of all points.
class ParametricRefinement {
 public:
  /// The points, and their tree, are those of the cloud.
  ParametricRefinement(const Cloud& cloud, const NearestPoints& points, const PointTree& tree,
                       const Surfels& surfels, const Context& context);

  /// The mirror that leaves the least robust residual on about `wanted` samples.
  template <typename Shape>
  Candidate<Shape> fitted(const Candidate<Shape>& start, Index wanted, int steps) const;

  /// Where the same points stand on both sides, converges on them to rounding; otherwise `start`.
  template <typename Shape>
  Candidate<Shape> fitted_to_exact_pairs(const Candidate<Shape>& start) const;

  /// The two changes of the mirror's numbers, columns, that the cloud's surfaces resist least,
  /// against how far they move the images: by 1, root mean square.
  template <typename Shape>
  Eigen::Matrix<double, Eigen::Dynamic, 2> loosest(const Shape& shape) const;

  /// How the mirror that the cloud asks for next to a plane bends: by least squares, robust.
  PlaneBend bend_of(const UnitPlane& plane) const;

  /// Of the samples the mirror moves, the share that meets the cloud.
  template <typename Shape>
  double support(const Shape& shape, Index wanted) const;

  /// Of the cloud's points, in the principal frame.
  double spacing() const { return spacing_; }

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

  // How far a partner may be: a few spacings, but no less than what the fits look over.
  double reach() const { return std::clamp(3 * spacing_, 2.5 * widest, 5 * widest); }

  static constexpr double widest = 0.012;

  Index stride_for(Index wanted) const;
  template <typename Shape>
  std::vector<Match> matches(const Shape& shape, double limit, Index stride) const;

  const Cloud& cloud_;
  const NearestPoints& points_;
  const Surfels& surfels_;
  const Context context_;
  double spacing_;
  std::vector<Sample> samples_;
};

}  // namespace symsurf
