#pragma once

#include <symsurf/parameter.h>

#include "cloud/cloud.h"
#include "spatial/point_tree.h"

namespace symsurf {

/// The parameters of methods that need normals: how they are estimated where
/// none are given.
std::vector<Parameter> normal_parameters();

/// Unit normals: the cloud's own, or estimated as the parameters say. The tree
/// is that of its points.
Points given_or_estimated_normals(const Cloud& cloud, const PointTree& tree,
                                  const ParameterValues& values, const Context& context);

/// Regression normals all point up, so their sign counts; others are lines.
bool signed_normals(const Cloud& cloud, const ParameterValues& values);

}  // namespace symsurf
