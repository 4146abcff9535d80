#pragma once

#include <symsurf/context.h>
#include <symsurf/method.h>
#include <symsurf/points_view.h>
#include <symsurf/result.h>
#include <symsurf/triangles_view.h>

#include <cstdint>
#include <string>

namespace symsurf {

struct Options {
  std::string method = "auto";
  Values parameters = {};   ///< the method's, by name; the rest keep their defaults
  PointsView normals = {};  ///< optional, one a point; taken as lines, their sign does not count
  std::uint64_t seed = 0;   ///< of the methods that draw at random
  /// Optional triangles between the points, which are then the vertices of a mesh: samples spread
  /// evenly over its surface find the mirror; score and candidates are those of the samples, pairs
  /// those of the vertices. There are none where a thousand or more vertices lie evenly. A mirror
  /// that maps vertices onto vertices, and the surface with them, scores 1. A face without an area
  /// is passed over. The thesis's methods, and processes that share out the points, see the points
  /// only.
  TrianglesView faces = {};
  /// Whether a point with a NaN or infinite coordinate is an error. Otherwise such points are left
  /// out, with their faces, and have no partners: Result::statistics has their number.
  bool refuse_nonfinite = false;
};

/// Finds the mirror of a point set. The points are read in place and must stay alive for the call.
/// Where the context has several processes, the points (maybe none) and normals are this process's,
/// all of them call this alike, and the mirror is that of the whole. Pairs are those of the own
/// points, numbered through all processes in the order of their ranks. With `plane` a process needs
/// memory for its own points only; for other methods the root, rank 0, gets all points and works
/// alone, so it is the one to cancel. Throws InvalidInput (too few finite points, more than 2^30 in
/// one process, all points equal or on one line, an extent beyond 1e-50 to 1e50, a coordinate
/// beyond 1e50, normals that are not one a point, not finite or zero, a face that names a point
/// which is not there), InvalidParameter (unknown method or parameter, value out of range) and
/// Cancelled.
Result detect(PointsView points, const Options& options = {}, const Context& context = {});

/// The length of which `detect`, run alike, takes parameters of the unit "diagonal" as fractions:
/// the diagonal of the axis-aligned bounding box of the points, without those that the method
/// leaves out as not finite or as outliers. `match` takes that of the method "auto". Of one
/// process's points; throws as detect does.
double diagonal(PointsView points, const Options& options = {}, const Context& context = {});

}  // namespace symsurf
