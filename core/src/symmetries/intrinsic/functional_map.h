#pragma once

#include <symsurf/context.h>

#include <string>
#include <vector>

#include "symmetries/intrinsic/connected_surface.h"

namespace symsurf {

/// A map of a surface onto itself, x -> T x, as the matrix with f(T x) = C' f(x) for the first
/// eigenfunctions f (Ovsjanikov et al. 2012). It is orthogonal, as the map is an isometry.
using FunctionalMap = Eigen::MatrixXd;

/// Values of functions at vertices with their weights, and where a map sends each of these.
class SampledFunctions {
 public:
  /// Of so many vertices of the basis.
  SampledFunctions(const SurfaceBasis& basis, const std::vector<Index>& vertices,
                   Eigen::VectorXd weights);

  /// Of each vertex the one, by its position among them, where the first functions are nearest to
  /// the mapped ones.
  std::vector<Index> images(const FunctionalMap& map) const;

  /// The orthogonal map of the first `count` functions that fits the images best (Procrustes).
  FunctionalMap fitted(const std::vector<Index>& images, Index count) const;

  /// Images and map by turns, of more functions each time (Melzi et al. 2019, ZoomOut).
  FunctionalMap refined(std::vector<Index> images, Index first, Index last, Index step,
                        const Context& context) const;

 private:
  Eigen::MatrixXd values_;  // a row a vertex
  Eigen::VectorXd weights_;
};

/// Of each vertex of the surface the one where the functions are nearest to the mapped ones.
std::vector<Index> all_images(const SurfaceBasis& basis, const FunctionalMap& map,
                              const Context& context);

/// An orientation-reversing map of a surface onto itself that keeps its eigenfunctions up to their
/// signs, and how well.
struct IntrinsicMap {
  FunctionalMap map;
  std::string signs;  ///< "+", "-" of the eigenfunctions that the search began with, "0": left out
  double orientation = 0;  ///< Orientation::of
  double distortion = 0;   ///< mean difference of distances before and after, in the longest one
  double moved = 0;        ///< mean distance from points to images, in the longest one
};

/// The best of the maps that the signs of the first eigenfunctions give (Nagar and Raman 2018: for
/// a symmetry and eigenvalues that differ, the functional map is diagonal, of 1 and -1). All signs
/// of a few functions are tried at samples, and the most promising ones that reverse the
/// orientation refined with ZoomOut and by distances along the surface. Empty signs: too few
/// eigenvalues stand alone.
IntrinsicMap search_map(const ConnectedSurface& surface, const SurfaceBasis& basis,
                        const SampledPoints& samples, const Context& context);

}  // namespace symsurf
