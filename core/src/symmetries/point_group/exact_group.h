#pragma once

#include <symsurf/context.h>

#include <optional>

#include "cloud/cloud.h"
#include "symmetries/point_group/point_group.h"
#include "symmetries/point_group/symmetry_fit.h"

namespace symsurf {

/// A point group where it stands in the principal frame.
struct PlacedGroup {
  PointGroup group;
  GroupPose pose;
};

/// The group of all isometries that map each point of a small set of distinct points, such as
/// landmarks or the atoms of a molecule, onto one of its points, to the rounding of single
/// precision. By trying all images of two points (Atallah 1985 in the plane). None where the
/// identity is the only one, or the set is large.
std::optional<PlacedGroup> exact_group(const Cloud& cloud, const Context& context);

}  // namespace symsurf
