#pragma once

#include <symsurf/detect.h>
#include <symsurf/mirrors.h>
#include <symsurf/parameter.h>

#include <functional>
#include <string>

#include "cloud/cloud.h"
#include "preprocess/preprocessing.h"

// The list of methods, and the parameters that several of them share. A new method is its own
// source file, a line here and a line in registry.cpp.

namespace symsurf {

class Refinement;
struct PlaneBend;

/// A method as the pipeline runs it: its description, its pre-processing and its function.
struct MethodImplementation : Method {
  Preprocessing preprocessing;
  /// Of a kind that "auto" tries beside the plane and the free form: how far a free form is from
  /// the nearest mirror of this kind.
  double (*distance_from)(const FreeForm&) = nullptr;
  /// Of such a kind: its mirror next to a plane, from how the cloud asks that to bend.
  std::shared_ptr<Mirror> (*bent_from)(const PlaneBend&, const Refinement&,
                                       const PrincipalFrame&) = nullptr;
  bool reports_unpaired_points = false;  ///< the pipeline adds "unpaired_points" to the statistics
  bool reports_mean_residual = false;    ///< and "mean_residual"
  /// Gets a validated cloud after pre-processing.
  std::function<Result(const Cloud&, const ParameterValues&, const Context&)> run;
};

MethodImplementation auto_method();
MethodImplementation plane_method();
MethodImplementation sphere_method();
MethodImplementation fixed_direction_method();
MethodImplementation perpendicular_method();
MethodImplementation cylinder_method();
MethodImplementation quadric_method();
MethodImplementation separation_method();
MethodImplementation separation_normals_method();
MethodImplementation normals_only_method();
MethodImplementation sphere_thesis_method();
MethodImplementation plane_icp_method();
MethodImplementation plane_svd_method();
MethodImplementation plane_hruda_method();

/// In the order of methods().
const std::vector<MethodImplementation>& implementations();

/// Throws InvalidParameter, listing the names there are.
const MethodImplementation& implementation(std::string_view name);

/// Of methods that search on surfels. `kind`: "the plane".
Parameter surfels_searched(Index usual, const std::string& kind);

/// `kinds`: "planes".
Parameter max_candidates(Index usual, Index most, const std::string& kinds);

Parameter pair_distance(double usual = 0.05);

/// Of methods that pair the points when the mirror is found; the registry adds it.
Parameter pairs();

/// Of all methods; the registry adds both.
Parameter minimum_score();
Parameter tolerance();

}  // namespace symsurf
