#pragma once

#include <symsurf/types.h>

namespace symsurf {

/// A height field mirror while it is searched for, in the principal frame.
struct FieldEstimate {
  Vector3 direction = Vector3::Zero();
  Points nodes;        ///< of the surface; none: nothing was found
  double support = 0;  ///< share of the displaced points that fall on the cloud, 0 to 1
};

}  // namespace symsurf
