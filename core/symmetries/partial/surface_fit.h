#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "thinned_surface.h"

namespace symsurf {

/// Fits maps to a thinned surface: iterative closest points with point-to-plane residuals (Chen and
/// Medioni 1992). The surface must outlive it.
class SurfaceFit {
 public:
  SurfaceFit(const ThinnedSurface& surface, bool scales) : surface_(surface), scales_(scales) {}

  const ThinnedSurface& surface() const { return surface_; }

  /// Where a map takes a point of the surface.
  struct Landing {
    Index partner = -1;  ///< nearest to the image; -1: none near
    double off = 0;      ///< the image from the partner's plane, diagonals
    bool agrees = false;
  };
  Landing landing(const Eigen::Affine3d& map, Index i, double tolerance) const;

  /// The share of these points whose images agree.
  double share(const Eigen::Affine3d& map, const std::vector<Index>& points,
               double tolerance) const;

  struct Fit {
    Eigen::Affine3d map;
    /// The motion of the images that the surface resists least, by a few tolerances.
    Eigen::Affine3d slide = Eigen::Affine3d::Identity();
  };
  /// The map after some Gauss-Newton steps on these points.
  Fit fitted(const Eigen::Affine3d& start, const std::vector<Index>& points, double tolerance,
             int steps) const;

  /// The share of these points that come off the surface whichever way their images slide: next to
  /// none of planes, balls, edges and bars, which slide on themselves. The most of so many slides,
  /// each twice as long as the one before.
  double hold(const Fit& fit, const std::vector<Index>& points, double tolerance, int slides) const;

  /// A translation or reflection in place of a motion or glide that fits these points no better.
  Eigen::Affine3d simplest(const Eigen::Affine3d& map, const std::vector<Index>& points,
                           double tolerance) const;

 private:
  double mean_square(const Eigen::Affine3d& map, const std::vector<Index>& points,
                     double tolerance) const;

  const ThinnedSurface& surface_;
  bool scales_;
};

}  // namespace symsurf
