#pragma once

#include <optional>

#include "symmetries/point_group/element_search.h"

namespace symsurf {

/// The axis of a surface of revolution of which part of the turn is there, a fifth at least where
/// its profile is curved.
struct Revolution {
  FoundDirection axis;  ///< the vote is that of turns by parts of what is there
  double turn = 0;      ///< the share of the full turn that is there, (0, 1]
};

/// All normals of a surface of revolution meet its axis: a linear line complex (Pottmann and
/// Randrup, "Rotational and helical surface approximation for reverse engineering", 1998), from
/// random samples, then by weights. Turns of the cloud refine it. None where the normals leave the
/// axis open, as those of a sphere or a plane do, or fewer than most of them meet one.
std::optional<Revolution> find_revolution(const SymmetryTest& test);

}  // namespace symsurf
