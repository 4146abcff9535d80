#pragma once

#include <symsurf/context.h>
#include <symsurf/parameter.h>
#include <symsurf/points_view.h>
#include <symsurf/principal_frame.h>
#include <symsurf/result.h>

#include <string>
#include <string_view>
#include <vector>

namespace symsurf {

/// A validated input, as every method gets it: at least Method::minimum_points finite points
/// that do not all lie on one line.
struct Cloud {
  PointsView points;
  PointsView normals;   ///< empty: none given; otherwise one line direction a point, sign ignored
  double diagonal = 0;  ///< of the axis-aligned bounding box
  PrincipalFrame frame;
  std::uint64_t seed = 0;
};

/// The one description of a method. Front ends are made by looping over methods().
struct Method {
  std::string name;
  std::string title;    ///< for menus: "Mirror plane"
  std::string summary;  ///< one sentence
  std::vector<Parameter> parameters;
  Index minimum_points = 4;
  bool automatic = false;  ///< one of those that "auto" tries
  Result (*run)(const Cloud&, const ParameterValues&, const Context&) = nullptr;
};

/// All methods, in the order front ends show them.
const std::vector<Method>& methods();

/// Throws InvalidParameter, listing the names there are.
const Method& method(std::string_view name);

}  // namespace symsurf
