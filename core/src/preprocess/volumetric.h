#pragma once

#include "cloud/cloud.h"

namespace symsurf {

/// Whether the points fill bodies, as the voxels of a mask do, rather than lie on surfaces.
/// Collective.
bool is_volumetric(const Cloud& cloud, const Context& context);

}  // namespace symsurf
