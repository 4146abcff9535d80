#pragma once

#include <symsurf/parameter.h>
#include <symsurf/types.h>

#include <string>
#include <string_view>
#include <vector>

namespace symsurf {

/// The one description of a method. Front ends are made by looping over methods().
struct Method {
  std::string name;
  std::string title;    ///< for menus: "Mirror plane"
  std::string summary;  ///< one sentence
  std::vector<Parameter> parameters;
  Index minimum_points = 4;
  bool automatic = false;  ///< one of those that "auto" tries
};

/// Of the parameter "tolerance" of all methods, in diagonals: the sides of scanned faces and skulls
/// differ by less.
inline constexpr double usual_tolerance = 0.004;

/// All methods, in the order front ends show them.
const std::vector<Method>& methods();

/// Throws InvalidParameter, listing the names there are.
const Method& method(std::string_view name);

}  // namespace symsurf
