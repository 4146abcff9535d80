#pragma once

#include <symsurf/context.h>
#include <symsurf/method.h>
#include <symsurf/points_view.h>
#include <symsurf/result.h>

#include <cstdint>
#include <string>

namespace symsurf {

struct Options {
  std::string method = "auto";
  Values parameters = {};   ///< the method's, by name; the rest keep their defaults
  PointsView normals = {};  ///< optional, one a point; taken as lines, their sign does not count
  std::uint64_t seed = 0;   ///< of the methods that draw at random
};

/// Finds the mirror of a point set. The points are read in place and must stay alive for the call.
/// Where the context's processes share out the point set, the points (maybe none) and normals are
/// this process's, all of them call this alike, and the mirror is that of the whole. Pairs are
/// those of the own points, numbered through all processes in the order of their ranks. With a
/// method that takes shares a process needs memory for its own points only; for the others the
/// first gets all and works alone, so it is the one to be told to stop. Throws InvalidInput (too
/// few points, more than 2^30 in one process, NaN or infinity, all points equal or on one line, an
/// extent beyond 1e-50 to 1e50), InvalidParameter (unknown method or parameter, value out of range)
/// and Cancelled.
Result detect(PointsView points, const Options& options = {}, const Context& context = {});

}  // namespace symsurf
