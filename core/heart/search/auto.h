#pragma once

#include <symsurf/mirrors.h>

#include <vector>

#include "cloud/cloud.h"
#include "cloud/point_tree.h"
#include "fit/refinement.h"
#include "score/mirror_score.h"
#include "search/methods.h"

namespace symsurf {

/// The mirrors of simple kinds that a cloud asks a plane to bend into: near the plane these are
/// found by descent, at a small part of what a search for mirrors of all sizes takes.
class BentPlanes {
 public:
  using Kinds = std::vector<const MethodImplementation*>;

  /// The cloud must outlive it.
  BentPlanes(const Cloud& cloud, const Context& context);

  /// That of these kinds which explains most, without pairs; without a mirror where the plane is
  /// not to bend.
  Result best_of(const Kinds& kinds, const Mirror& plane) const;

  /// That of one kind, with the kind's parameters.
  Result with_pairs(const MethodImplementation& kind, const Mirror& plane,
                    const ParameterValues& values, const Context& context) const;

 private:
  PlaneBend bend_of(const Mirror& plane) const;
  Result best_of(const Kinds& kinds, const PlaneBend& bend) const;

  const Cloud& cloud_;
  NearestPoints points_;
  Refinement refinement_;
  MirrorScore score_;
};

/// How far a free form is, root mean square of its patches' centres, from the sphere that fits them
/// best (least squares: Coope 1993).
double distance_from_sphere(const FreeForm& mirror);

/// The same of the circular cylinder, its axis the direction that lies across most of the normals.
double distance_from_cylinder(const FreeForm& mirror);

}  // namespace symsurf
