#pragma once

#include <symsurf/parameter.h>

#include <vector>

#include "cloud/surface_points.h"
#include "fixed_direction/mapping_directions.h"

namespace symsurf {

/// A height field mirror while it is searched for, in the principal frame.
struct FieldEstimate {
  Vector3 direction = Vector3::Zero();
  Points nodes;        ///< of the surface; none: nothing was found
  double support = 0;  ///< share of the displaced points that fall on the cloud, 0 to 1
};

/// Finds the direction of mapping and the surface. A direction other than zero is taken as given
/// but for the last degree.
FieldEstimate find_height_field(const SurfacePoints& cloud, const Vector3& given_direction,
                                Values& statistics, const Context& context);

/// The mirror of a cloud whose points have exact partners along one direction, to rounding; an
/// estimate without nodes where they have none. Of several directions that many pairs share, as in
/// clouds on a grid, the one that meets the surfaces most squarely. `cone`: how far off, in
/// radians, the peaks may be; chords by chance hide the partners in too wide a one.
FieldEstimate exact_partners(const SurfacePoints& cloud, const std::vector<ChordPeak>& peaks,
                             double cone, const Context& context);

}  // namespace symsurf
