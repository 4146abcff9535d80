#pragma once

#include <symsurf/analyses.h>

#include "cloud/cloud.h"
#include "operations/operation.h"

// A new analysis is its own folder, a line here and a line in core/analyses.cpp.

namespace symsurf {

/// What an analysis is given.
struct ColouredCloud : Cloud {
  Eigen::MatrixXd colours;  ///< one row a point, or none
  Cloud other;              ///< validated as well, where the analysis takes one
};

/// An analysis and how it runs.
struct AnalysisImplementation : Analysis {
  Index maximum_points = 0;  ///< that memory is enough for; 0: any number
  /// Gets a validated cloud of finite points, with its faces; fills in all but parameters,
  /// footprint and seconds, with a row of the arrays for each point of the cloud.
  void (*run)(const ColouredCloud& cloud, const ParameterValues& values, const Context& context,
              AnalysisResult& result) = nullptr;
};

AnalysisImplementation symmetries_analysis();
AnalysisImplementation symmetry_embedding_analysis();
AnalysisImplementation intrinsic_symmetry_analysis();
AnalysisImplementation partial_symmetries_analysis();
AnalysisImplementation recurring_parts_analysis();
AnalysisImplementation helical_symmetry_analysis();
AnalysisImplementation match_pair_analysis();

/// Throws InvalidInput unless there are no colours, or one a point, finite where the point is.
void require_colours(PointsView points, const Eigen::MatrixXd& colours);

/// The name of a motion, reflection or similarity, as Transformation::kind has it. What differs by
/// less than the tolerances, in radians and input units, is the same. `centre`: of the shape, where
/// a turn that is none moves nothing far.
std::string kind_of(const Matrix4& matrix, const Vector3& centre, double angle_tolerance,
                    double length_tolerance);

/// The completion with turns about an axis as well, where the parameter "symmetry" asks for them:
/// turn after turn of what is there by then, each the least that lays most of the shape where it
/// lacks something.
OperationImplementation also_about_axis(OperationImplementation completion);

}  // namespace symsurf
