#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "cloud/cloud.h"
#include "cloud/point_tree.h"
#include "cloud/principal_frame.h"
#include "cloud/surfels.h"
#include "fit/candidate.h"
#include "fit/shapes.h"
#include "pairing/correspondence.h"

namespace symsurf {

/// How many samples a fit looks at, how far off their partners may be at first, in diagonals, and
/// how many steps it takes.
struct Fit {
  Index samples;
  double tolerance = 0.012;
  int steps;
};

/// Patches of the finer surfels, each of which has a sample, over those of the coarse ones: what
/// bends a mirror shows in more of them than what turns a plane.
inline constexpr Index samples_a_patch = 12;

/// Fits mirrors of few numbers, the shapes of shapes.h, to the full cloud: samples of it are
/// mirrored and meet the nearest of all points.
class Refinement {
 public:
  /// The surfels give the normals, at each position the flattest.
  Refinement(const Cloud& cloud, const NearestPoints& points, const Surfels& coarse,
             const Surfels& fine);

  /// The mirror that leaves the least robust residual.
  template <typename Shape>
  Shape fitted(Shape shape, const Fit& fit) const;

  /// The same with its support on about as many samples.
  template <typename Shape>
  Candidate<Shape> fitted(const Candidate<Shape>& start, const Fit& fit) const;

  /// The mirror fitted to all that roughly agrees, then to what agrees closely, which nothing
  /// beside a hole pulls away; to rounding where partners are exact.
  template <typename Shape>
  Shape refined(const Shape& start) const;

  /// The mirror of points that have exact partners over it; `start` where there are none.
  template <typename Shape>
  Shape exact(const Shape& start) const;

  /// Share of about so many samples, out of those the mirror moves, whose images land on the cloud;
  /// of planes an image just beside it counts against them.
  template <typename Shape>
  double support(const Shape& shape, Index samples) const;

  /// The two changes of the mirror's numbers, columns, that the cloud's surfaces resist least,
  /// against how far they move the images: by 1, root mean square.
  template <typename Shape>
  Eigen::Matrix<double, Eigen::Dynamic, 2> loosest(const Shape& shape) const;

  /// How the mirror that the cloud asks for next to a plane bends: by least squares, robust.
  PlaneBend bend_of(const UnitPlane& plane) const;

  /// Of the cloud's points on a surface, in the principal frame.
  double spacing() const { return spacing_; }

 private:
  struct Sample {
    Vector3 point;
    const Surfel* surfel;
    std::uint32_t position;    // along a curve that fills space
    Vector3 smoothed = point;  // less its noise
  };
  struct Match {
    const Sample* sample;
    Vector3 partner;
    const Surfel* surfel;  // the partner's
  };

  // The stride between samples, for about so many.
  Index stride_for(Index wanted) const;
  SurfaceNoise measured_noise() const;
  const Surfel* surfel_at(const Vector3& x) const { return flattest_at({&coarse_, &fine_}, x); }
  template <typename Shape>
  std::vector<Match> matches(const Shape& shape, double limit, Index stride) const;
  template <typename Shape>
  const Vector3& position(const Sample& sample) const;
  // From the partner to the image.
  template <typename Shape>
  Vector3 gap(const Shape& shape, const Match& match) const;

  const Cloud& cloud_;
  const NearestPoints& points_;
  const Surfels &coarse_, &fine_;
  double spacing_;
  SurfaceNoise noise_;
  NearMissKernel kernel_;
  std::vector<Sample> samples_;  // spread evenly over the cloud
};

/// Where noise or a dent hides which points are partners, surfaces alone distinguish mirrors that
/// slide along them, and a fit creeps: slides the mirror over the plane of its loosest changes, for
/// as long as another position explains clearly more. Without it one of ten dented balls loses its
/// cylinder. Then it is fitted closely, and to rounding where partners are exact.
template <typename Shape>
Candidate<Shape> polished(const Candidate<Shape>& candidate, const Fit& fit,
                          const Refinement& refinement);

}  // namespace symsurf
