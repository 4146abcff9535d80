#pragma once

#include <symsurf/analyses.h>

#include <functional>
#include <optional>

#include "cloud/cloud.h"
#include "point_group/element_search.h"
#include "point_group/point_group.h"

namespace symsurf {

/// A point group that stands in a pose of the principal frame, in input units.
Symmetries described(const PointGroup& group, const GroupPose& pose, const OrbitVote& vote,
                     const PrincipalFrame& frame);

/// The point group of a validated cloud in one process. Elements are proposed by candidate planes,
/// by the lines that these meet in and by the principal axes; the groups that they may make are
/// fitted and judged as a whole, the largest first. `is_set`: the points are no sample of faces; of
/// few, what maps them exactly onto one another counts before. Of a surface of revolution any part
/// of the turn may be missing. `accepts`: whether a group that was found is one; it may fill in
/// more of it.
Symmetries search_symmetries(const Cloud& cloud, bool is_set, double minimum_score,
                             const std::function<bool(Symmetries&)>& accepts,
                             const Context& context);

/// The axis of the highest order, continuous ones first, or that of what is mostly a surface of
/// revolution, whatever spoils it, as a handle or a broken edge does. Throws what find_symmetries()
/// does.
std::optional<SymmetryAxis> find_axis(PointsView points, TrianglesView faces,
                                      const Context& context);

}  // namespace symsurf
