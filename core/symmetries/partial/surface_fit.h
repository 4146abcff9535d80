#pragma once

#include <Eigen/Geometry>
#include <optional>
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

  /// The map after some Gauss-Newton steps on these points.
  Eigen::Affine3d fitted(const Eigen::Affine3d& start, const std::vector<Index>& points,
                         double tolerance, int steps) const;

  /// The share of these points that come off the surface whichever way their images slide: next to
  /// none of planes, balls, edges and bars, which slide on themselves. The most of so many slides,
  /// each twice as long as the one before.
  double hold(const Eigen::Affine3d& map, const std::vector<Index>& points, double tolerance,
              int slides) const;

  /// A translation or reflection in place of a motion or glide that fits these points no better.
  Eigen::Affine3d simplest(const Eigen::Affine3d& map, const std::vector<Index>& points,
                           double tolerance) const;

 private:
  // The motion of the images that the surface resists least, by a few tolerances.
  Eigen::Affine3d loosest(const Eigen::Affine3d& map, const std::vector<Index>& points,
                          double tolerance) const;
  double mean_square(const Eigen::Affine3d& map, const std::vector<Index>& points,
                     double tolerance) const;

  const ThinnedSurface& surface_;
  bool scales_;
};

/// A connected patch of a thinned surface and where a map takes it.
struct PatchPair {
  Eigen::Affine3d map = Eigen::Affine3d::Identity();
  std::vector<Index> from, onto;  ///< points of the patch, ascending; the nearest to their images
  double score = 0;  ///< 0..1: how close images come to the surface, of how close its points do
  double hold = 0;   ///< as SurfaceFit::hold
};

/// Grows the patch on which a map holds (Mitra et al. 2006), and fits the map to it.
class PatchGrowth {
 public:
  explicit PatchGrowth(const SurfaceFit& fit);

  /// From some points that the map takes about to the surface; nothing where the map does not hold
  /// on most of them, or on fewer than `least` points after growing.
  std::optional<PatchPair> grown(const Eigen::Affine3d& map, const std::vector<Index>& seeds,
                                 Index least, const Context& context) const;

 private:
  std::vector<Index> agreeing(const Eigen::Affine3d& map, const std::vector<Index>& seeds) const;
  void score(PatchPair& pair) const;

  const SurfaceFit& fit_;
  double tolerance_;
  std::vector<double> ceilings_;  // how close each point comes to the surface of the others
};

}  // namespace symsurf
