#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "partial/surface_fit.h"

namespace symsurf {

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
