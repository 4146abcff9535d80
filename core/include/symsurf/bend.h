#pragma once

#include <symsurf/context.h>
#include <symsurf/mirror.h>
#include <symsurf/plane.h>

namespace symsurf {

enum class Bend {
  Straighten,  ///< carry points along while the mirror flattens into its plane
  Restore,     ///< the way back: bends what is symmetric about the plane
};

/// Carries points along with their mirror: each keeps its distance from the mirror and the
/// coordinates of its foot. A cylinder unrolls; other mirrors are laid out from the middle of their
/// footprint along the two directions they bend in most and least, true to length along the two
/// lines through the middle, so the mirror must be a graph over its tangent plane there. A shape
/// that the mirror reflects onto itself comes out symmetric about straight_mirror().
/// A mirror made by hand is laid out over the points' feet unless it was given a footprint; going
/// there and back needs the same footprint. Points beyond the mirror, which have no foot on it, go
/// rigidly with the nearest that has one; `unplaced`, where given, is set to their number. Rows
/// that are not finite stay so. Throws InvalidInput when no point of the footprint, or none of the
/// points, has a foot or the points extend over more than 1e50, Cancelled.
Points bend(PointsView points, const Mirror& mirror, Bend way = Bend::Straighten,
            const Context& context = {}, Index* unplaced = nullptr);

/// The plane that the mirror becomes: its tangent plane in the middle of its footprint.
/// `object` stands in for a mirror made by hand's missing footprint.
Plane straight_mirror(const Mirror& mirror, PointsView object = {});

}  // namespace symsurf
