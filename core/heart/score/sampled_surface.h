#pragma once

#include <symsurf/context.h>

#include <vector>

#include "cloud/cloud.h"
#include "cloud/point_tree.h"

namespace symsurf {

/// A point and the normal of the surface through it; in the principal frame, as all lengths here.
struct ImagePoint {
  Vector3 position, normal;
};

/// The plane through some of a cloud's points.
struct LocalFacet {
  Vector3 mean = Vector3::Zero(), normal = Vector3::Zero();
  double flatness = 0;  ///< 1: of a surface, 0: of a volume or a line, without a normal

  double above(const Vector3& x) const { return normal.dot(x - mean); }
};

/// Diagonals: images farther off have no partner.
inline constexpr double farthest_residual = 0.03;

/// The surface of a cloud at the scale of its sampling: points spread evenly over it, each with the
/// plane through half of its neighbours. How far the point lies from the plane of the other half
/// says what a mirror image can reach at most.
class SampledSurface {
 public:
  struct Sample {
    Vector3 position;
    LocalFacet facet;  ///< of half of its neighbours
    double above = 0;  ///< where noise shows, how far it lies above that plane: images are of the
                       ///< point without it
    LocalFacet patch;  ///< of all points of some cells around it
    double noise;      ///< root mean square distance of the samples around it from their planes
    double spacing;    ///< median distance to their third neighbours
    double ceiling;    ///< support of the sample for itself, by the other half
    double around;     ///< samples near it
  };

  /// What the cloud has where the image of a sample falls.
  struct Landing {
    double support = 0;   ///< 0..1: the cloud's surface passes there, with that normal
    LocalFacet facet;     ///< of the cloud there
    double residual = 0;  ///< of the image from it
    double there = 0;     ///< how much of the cloud is near, over what is near the sample
    bool exact = false;   ///< the image is a point of the cloud, to rounding
    bool ends = false;    ///< the cloud's surface ends before
    Index sample = -1;    ///< the nearest one
  };

  /// About `count` samples, at most half as many as points. The cloud must outlive it, and keep its
  /// tree.
  SampledSurface(const Cloud& cloud, Index count, const Context& context);

  Index size() const { return static_cast<Index>(samples_.size()); }
  const Sample& operator[](Index k) const { return samples_[k]; }
  Landing landing(const Sample& sample, const ImagePoint& image) const;

  /// The numbers of the samples nearest to a position.
  std::vector<Index> nearest(const Vector3& position, Index count) const;

 private:
  double around(const Vector3& position) const;
  std::vector<Neighbour> neighbours(const Vector3& position, Index count) const;
  double third_of(const std::vector<Neighbour>& neighbours) const;
  LocalFacet facet(const std::vector<Neighbour>& neighbours, std::size_t first) const;

  const Cloud& cloud_;
  const PointTree& tree_;
  bool is_noisy_ = false;
  bool fills_volume_ = false;  // or scattered: then images have to meet points, not planes
  const Surfels& patches_;
  Points positions_;  // of the samples
  PointTree sample_tree_;
  std::vector<Sample> samples_;
};

}  // namespace symsurf
