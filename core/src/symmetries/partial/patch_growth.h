#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "symmetries/thinned_surface.h"

namespace symsurf {

/// A connected patch of a thinned surface and where a map takes it.
struct PatchPair {
  Eigen::Affine3d map = Eigen::Affine3d::Identity();
  std::vector<Index> from, onto;  ///< points of the patch, ascending; the nearest to their images
  double score = 0;  ///< 0..1: how close images come to the surface, of how close its points do
  double hold = 0;  ///< as PatchGrowth::hold
};

/// Fits maps to the surface and grows the patch on which they hold: iterative closest points with
/// point-to-plane residuals (Chen and Medioni 1992) and Mitra et al.'s patch growing (2006).
class PatchGrowth {
 public:
  PatchGrowth(const ThinnedSurface& surface, bool scales);

  /// From some points that the map takes about to the surface; nothing where the map does not hold
  /// on most of them, or on fewer than `least` points after growing.
  std::optional<PatchPair> grown(const Eigen::Affine3d& map, const std::vector<Index>& seeds,
                                 Index least, const Context& context) const;

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

  /// The map after some Gauss-Newton steps on these points.
  struct Fit {
    Eigen::Affine3d map;
    /// The motion that the points resist least, by a few tolerances.
    Eigen::Affine3d slide = Eigen::Affine3d::Identity();
  };
  /// The share of these points that come off the surface whichever way their images slide: 0 of
  /// planes, balls, edges and bars, which slide on themselves.
  double hold(const Fit& fit, const std::vector<Index>& points, double tolerance) const;

  Fit fitted(const Eigen::Affine3d& map, const std::vector<Index>& points, double tolerance,
             int steps) const;

 private:
  std::vector<Index> agreeing(const Eigen::Affine3d& map, const std::vector<Index>& seeds,
                              double tolerance) const;

  const ThinnedSurface& surface_;
  bool scales_;
  std::vector<double> ceilings_;  // how close each point comes to the surface of the others
};

}  // namespace symsurf
