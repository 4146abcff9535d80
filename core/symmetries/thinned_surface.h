#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "cloud/cloud.h"
#include "cloud/surface_points.h"
#include "cloud/surfels.h"
#include "preprocess/surface_samples.h"

namespace symsurf {

/// A cloud thinned evenly to points of its surfaces with normals and neighbours, in the principal
/// frame: how densely a place was sampled does not count. Faces are sampled first, noise is
/// smoothed.
class ThinnedSurface {
 public:
  /// About `count` points, of a small cloud less: no more than half of its own.
  ThinnedSurface(const Cloud& cloud, Index count, const Context& context);

  const SurfacePoints& points() const { return points_; }
  Index size() const { return points_.size(); }

  /// How far the thinned points lie apart, diagonals.
  double spacing() const { return points_.spacing; }

  /// The area of the surface, diagonals squared.
  double area() const { return static_cast<double>(size()) * spacing() * spacing(); }

  /// The thinned point nearest to x, to half a spacing; -1 where none lies within one and a half.
  Index nearest(const Vector3& x) const { return map_.nearest(x); }

  /// How far off a surface one of the thinned points may lie for its noise and their spacing.
  double tolerance() const;

  /// The cloud's points near each of the thinned points; none of clutter.
  const std::vector<std::vector<Index>>& near() const { return near_; }

  /// The cloud's points near these thinned points, ascending.
  std::vector<Index> near(const std::vector<Index>& thinned) const;

  /// Points of the surface in the principal frame by the number of the nearest thinned point in
  /// `parts`, -1: in none.
  std::vector<Points> divided(const std::vector<Index>& parts, const Context& context) const;

  /// A map of the principal frame as one of the cloud's coordinates.
  Matrix4 in_input_units(const Eigen::Affine3d& map) const;

 private:
  SurfaceSamples sampling_;
  Cloud cloud_;
  const Surfels& surfels_;
  SurfelMap map_;
  double noise_ = 0;  // before it was smoothed away
  SurfacePoints points_;
  std::vector<std::vector<Index>> near_;
};

}  // namespace symsurf
