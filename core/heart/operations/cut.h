#pragma once

#include "operations/half.h"

namespace symsurf {

/// Faces within a mirror that close a half where it is cut.
struct Cap {
  Points points;    ///< within the cut, behind those of the half
  Triangles faces;  ///< of points of the half and of these
  Index open = 0;   ///< curves of the cut that do not close: the shape ends at them
};

/// Triangles about as large as the faces of the half. Closed curves within others bound holes.
Cap cap_of(const Half& half, const Mirror& mirror, const Context& context);

}  // namespace symsurf
