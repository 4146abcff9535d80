#pragma once

#include <optional>

#include "point_group/element_search.h"

namespace symsurf {

/// The axis of a surface of revolution of which part of the turn is there.
struct Revolution {
  FoundDirection axis;  ///< the vote is that of turns by parts of what is there
  double turn = 0;      ///< the share of the full turn that is there, (0, 1]
};

/// All normals of a surface of revolution meet its axis: a linear line complex (Pottmann and
/// Randrup, "Rotational and helical surface approximation for reverse engineering", 1998), from
/// random samples, then by weights. Then the points, turned into one half plane, are to scatter
/// least about a profile. None where turns of the cloud do not fit it.
std::optional<Revolution> find_revolution(const Cloud& cloud, const SymmetryTest& test,
                                          const Context& context);

}  // namespace symsurf
