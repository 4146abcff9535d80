#pragma once

#include <symsurf/operations.h>

#include <algorithm>
#include <string>

#include "vtk_names.h"

/// "Mirror asymmetry" -> "MirrorAsymmetry".
inline std::string joined_title(std::string title) {
  std::replace(title.begin(), title.end(), ' ', '_');
  return vtk_name(title);
}

/// "MirrorAsymmetry": the filter is "vtk" and this.
inline std::string filter_name(const symsurf::Operation& operation) {
  return joined_title(operation.title);
}

/// "MirrorAsymmetryDistance": an input may have a "Distance" of its own.
inline std::string array_name(const symsurf::Operation& operation, const std::string& array) {
  return filter_name(operation) + vtk_name(array);
}
