#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "cloud/cloud.h"
#include "cloud/point_tree.h"
#include "cloud/principal_frame.h"
#include "cloud/surfels.h"
#include "fit/candidate.h"
#include "fit/fitted.h"
#include "fit/shapes.h"
#include "pairing/correspondence.h"

namespace symsurf {

/// How many samples a fit looks at, how far off their partners may be at first and at last, in
/// diagonals, and how many steps it takes.
struct Fit {
  Index samples;
  double tolerance = 0.012;
  int steps;
  double narrowest = 0.002;
};

/// What searches ask for. Few samples are enough to tell which planes are worth more; of curved
/// mirrors each candidate takes as many steps as planes in all, and the best of them more.
inline constexpr Fit quick{.samples = 250, .tolerance = 0.02, .steps = 2},
    careful{.samples = 1300, .tolerance = 0.01, .steps = 2}, of_each{.samples = 400, .steps = 4},
    of_best{.samples = 3000, .steps = 40};

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

  /// The maps that leave the least robust residual; see fitted.h.
  template <typename Map>
  std::vector<Map> fitted(const std::vector<Map>& maps, const Fit& fit) const;
  template <typename Shape>
  Shape fitted(const Shape& shape, const Fit& fit) const {
    return fitted(std::vector<Shape>{shape}, fit).front();
  }

  /// The same with its support on about as many samples.
  template <typename Shape>
  Candidate<Shape> fitted(const Candidate<Shape>& start, const Fit& fit) const;

  /// The mirror fitted to all that roughly agrees, then to what agrees closely, which nothing
  /// beside a hole pulls away; to rounding where partners are exact. `onto`: the cloud that has the
  /// images, where a map lays this one on another.
  template <typename Shape>
  Shape refined(const Shape& start, const Refinement& onto) const;
  template <typename Shape>
  Shape refined(const Shape& start) const {
    return refined(start, *this);
  }

  /// The mirror of points that have exact partners over it; `start` where there are none.
  template <typename Shape>
  Shape exact(const Shape& start, const Refinement& onto) const;
  template <typename Shape>
  Shape exact(const Shape& start) const {
    return exact(start, *this);
  }

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
  const SurfaceNoise& noise() const { return noise_; }
  const Surfel* surfel_at(const Vector3& x) const { return flattest_at({&coarse_, &fine_}, x); }

 private:
  struct Sample {
    Vector3 point;
    const Surfel* surfel;
    std::uint32_t position;    // along a curve that fills space
    Vector3 smoothed = point;  // less its noise
  };
  // Matches on every so many samples.
  class Matching {
   public:
    Matching(const Refinement& cloud, const Refinement& onto, Index stride)
        : cloud_(cloud), onto_(onto), stride_(stride) {}

    double spacing() const { return onto_.spacing_; }
    template <typename Map>
    std::vector<Match> matches(const std::vector<Map>& maps, double limit) const {
      return cloud_.matches(maps, limit, stride_, onto_);
    }

   private:
    const Refinement &cloud_, &onto_;
    Index stride_;
  };

  // The stride between samples, for about so many.
  Index stride_for(Index wanted) const;
  SurfaceNoise measured_noise() const;
  template <typename Map>
  std::vector<Match> matches(const std::vector<Map>& maps, double limit, Index stride,
                             const Refinement& onto) const;
  template <typename Shape>
  std::vector<Match> matches(const Shape& shape, double limit, Index stride) const {
    return matches(std::vector<Shape>{shape}, limit, stride, *this);
  }
  template <typename Map>
  std::vector<Map> fitted(const std::vector<Map>& maps, const Fit& fit,
                          const Refinement& onto) const;
  template <typename Map>
  const Vector3& position(const Sample& sample) const;

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

template <typename Map>
const Vector3& Refinement::position(const Sample& sample) const {
  return Map::is_affine ? sample.smoothed : sample.point;
}

template <typename Map>
std::vector<Match> Refinement::matches(const std::vector<Map>& maps, double limit, Index stride,
                                       const Refinement& onto) const {
  struct Asked {
    const Sample& sample;
    std::size_t map;
  };
  std::vector<Asked> asked;
  std::vector<Vector3> images;
  for (std::size_t k = 0; k < maps.size(); ++k)
    for (std::size_t i = 0; i < samples_.size(); i += stride) {
      const Vector3 image = maps[k].reflect(samples_[i].point);
      if (!image.allFinite()) continue;
      asked.push_back({samples_[i], k});
      images.push_back(onto.cloud_.frame.from_frame(image));
    }
  const std::vector<Vector3> partners =
      onto.points_.nearest(images, limit * onto.cloud_.frame.size);
  std::vector<Match> found;
  found.reserve(asked.size());
  for (std::size_t k = 0; k < asked.size(); ++k) {
    if (!partners[k].allFinite()) continue;
    const Vector3 x = onto.cloud_.frame.to_frame(partners[k]);
    const Surfel* surfel = onto.surfel_at(x);
    if (!surfel) continue;
    found.push_back({position<Map>(asked[k].sample),
                     *asked[k].sample.surfel,
                     Map::is_affine ? onto.noise_.smoothed(x, *surfel) : x,
                     {surfel->normal, surfel->flatness_without(onto.noise_.deviation())},
                     asked[k].map});
  }
  return found;
}

template <typename Map>
std::vector<Map> Refinement::fitted(const std::vector<Map>& maps, const Fit& fit,
                                    const Refinement& onto) const {
  return symsurf::fitted(maps, Matching(*this, onto, stride_for(fit.samples)),
                         {fit.tolerance, fit.narrowest, fit.steps},
                         SurfaceKernel{onto.spacing_, 0.01})
      .maps;
}

template <typename Map>
std::vector<Map> Refinement::fitted(const std::vector<Map>& maps, const Fit& fit) const {
  return fitted(maps, fit, *this);
}

}  // namespace symsurf
