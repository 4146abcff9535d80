#pragma once

#include <symsurf/context.h>

#include <string>
#include <vector>

#include "symmetries/intrinsic/connected_surface.h"
#include "symmetries/intrinsic/patches.h"

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

/// A map of a surface onto itself, by where it sends samples, that keeps its eigenfunctions up to
/// their signs.
struct IntrinsicMap {
  std::vector<Index> images;  ///< vertices
  std::string signs;  ///< "+", "-" of the eigenfunctions that the search began with, "0": left out
  double distortion = 0;  ///< mean difference of distances before and after, in the longest one
  double moved = 0;       ///< mean distance from points to images, in the longest one
  PatchChange change;     ///< of patches about the samples
};

/// Whether a map keeps distances along the surface and the shapes of patches better than another,
/// for how far it moves points.
bool is_better(const IntrinsicMap& one, const IntrinsicMap& other);

/// Sets where the map sends samples, and how well it keeps distances and the patches' shapes.
void set_images(std::vector<Index> images, const SampledPoints& samples, const Patches& patches,
                IntrinsicMap& map);

/// Maps that turn the surface over, the best first, from the signs of the first eigenfunctions
/// (Nagar and Raman 2018: for a symmetry and eigenvalues that differ, the functional map is
/// diagonal, of 1 and -1). All signs of a few functions are tried at samples, and the most
/// promising ones that reverse the orientation refined with ZoomOut and by distances along the
/// surface. None where too few eigenvalues stand alone.
std::vector<IntrinsicMap> search_maps(const SurfaceBasis& basis, const SampledPoints& samples,
                                      const Patches& patches, const Context& context);

}  // namespace symsurf
