#pragma once

#include <symsurf/detect.h>
#include <symsurf/mirrors.h>
#include <symsurf/parameter.h>

#include <functional>
#include <string>

#include "cloud/cloud.h"
#include "preprocess/preprocessing.h"

// The methods of the heart, and the parameters that several of them share.

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
MethodImplementation oblique_plane_method();
MethodImplementation sphere_method();
MethodImplementation fixed_direction_method();
MethodImplementation perpendicular_method();
MethodImplementation cylinder_method();
MethodImplementation quadric_method();
/// The methods with the parameters that all have: those of pairs, the verdict and the tolerance.
std::vector<MethodImplementation> with_shared_parameters(std::vector<MethodImplementation> methods);

/// Those that search for a mirror of any body, in the order of methods().
const std::vector<MethodImplementation>& heart_methods();

/// One of them; throws InvalidParameter, listing the names there are.
const MethodImplementation& heart_method(std::string_view name);

/// Of methods that search on surfels. `kind`: "the plane".
Parameter surfels_searched(Index usual, const std::string& kind);

/// `kinds`: "planes".
Parameter max_candidates(Index usual, Index most, const std::string& kinds);

Parameter pair_distance(double usual = 0.05);

/// Of methods that pair the points when the mirror is found; with_shared_parameters() adds it.
Parameter pairs();

/// Of all methods; with_shared_parameters() adds both.
Parameter minimum_score();
Parameter tolerance();

}  // namespace symsurf
