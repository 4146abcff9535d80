#pragma once

#include <symsurf/analyses.h>
#include <symsurf/operations.h>

#include <optional>
#include <vector>

namespace symsurf {

/// Parameters of what is done about an axis in place of a mirror.
std::vector<Parameter> axis_parameters();

/// The axis that they give, or the main one of the shape where they give none. Throws
/// InvalidParameter where they make no axis, InvalidInput where it is far from the points or none
/// is found.
SymmetryAxis axis_of(const OperationInput& input, const ParameterValues& values,
                     const Context& context);

/// The least turn about the axis, in radians, of those that lay most of the shape where the turned
/// shape has nothing: what it lacks is filled by few. None where it lacks next to nothing.
std::optional<double> covering_turn(PointsView points, TrianglesView faces,
                                    const SymmetryAxis& axis, const Context& context);

}  // namespace symsurf
