#pragma once

#include "methods/height_field/field_estimate.h"
#include "methods/height_field/working_cloud.h"

namespace symsurf {

/// Finds the direction of mapping and the surface. A direction other than zero is taken as given
/// but for the last degree.
FieldEstimate find_height_field(const WorkingCloud& cloud, const Vector3& given_direction,
                                Values& statistics, const Context& context);

}  // namespace symsurf
