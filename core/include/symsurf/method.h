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
/// that do not all lie on one line. Where processes share it out, points and normals are this one's
/// and the rest is that of the whole.
struct Cloud {
  PointsView points;
  PointsView normals;   ///< empty: none given; otherwise one line direction a point, sign ignored
  PointsView vertices;  ///< where the points are samples of a mesh: its vertices
  double diagonal = 0;  ///< of the axis-aligned bounding box
  PrincipalFrame frame;
  std::uint64_t seed = 0;
  Index first = 0;  ///< how many points the processes before this one have
  Index total = 0;  ///< of all processes
};

/// The one description of a method. Front ends are made by looping over methods().
struct Method {
  std::string name;
  std::string title;    ///< for menus: "Mirror plane"
  std::string summary;  ///< one sentence
  std::vector<Parameter> parameters;
  Index minimum_points = 4;
  bool automatic = false;  ///< one of those that "auto" tries
  bool takes_shares =
      false;  ///< run can do with a share of the points; else the first process gets all
  bool sees_copies = false;  ///< run gets points that are copies of others; else their places
  /// Run gets the few points far off all others, and the vertices of a mesh; else the rest, and
  /// samples of the mesh's surface.
  bool sees_strays = false;
  bool sees_inside = false;  ///< run gets all points of bodies filled with them; else their skin
  Result (*run)(const Cloud&, const ParameterValues&, const Context&) = nullptr;
};

/// All methods, in the order front ends show them.
const std::vector<Method>& methods();

/// Throws InvalidParameter, listing the names there are.
const Method& method(std::string_view name);

}  // namespace symsurf
