#pragma once

#include <string>
#include <vector>

#include "symmetries/intrinsic/functional_map.h"

namespace symsurf {

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
