#pragma once

#include <symsurf/context.h>

#include <string>
#include <vector>

#include "intrinsic/connected_surface.h"
#include "intrinsic/patches.h"

namespace symsurf {

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
