#pragma once

#include <symsurf/operation.h>

#include <algorithm>
#include <string>

#include "vtk_names.h"

/// "Mirror asymmetry" -> "MirrorAsymmetry": the filter is "vtk" and this.
inline std::string filter_name(const symsurf::Operation& operation) {
  std::string words = operation.title;
  std::replace(words.begin(), words.end(), ' ', '_');
  return vtk_name(words);
}

/// "MirrorAsymmetryDistance": an input may have a "Distance" of its own.
inline std::string array_name(const symsurf::Operation& operation, const std::string& array) {
  return filter_name(operation) + vtk_name(array);
}
