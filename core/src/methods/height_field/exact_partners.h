#pragma once

#include <vector>

#include "methods/height_field/chord_histogram.h"
#include "methods/height_field/field_search.h"

namespace symsurf {

/// The mirror of a cloud whose points have exact partners along one direction, to rounding; an
/// estimate without nodes where they have none. Of several directions that many pairs share, as in
/// clouds on a grid, the one that meets the surfaces most squarely. `cone`: how far off, in
/// radians, the peaks may be; chords by chance hide the partners in too wide a one.
FieldEstimate exact_partners(const SurfacePoints& cloud, const std::vector<ChordPeak>& peaks,
                             double cone, const Context& context);

}  // namespace symsurf
