#include <symsurf/errors.h>
#include <symsurf/symmetries.h>
#include <symsurf/value.h>

#include <chrono>

#include "detection/pipeline.h"
#include "symmetries/analysis_registry.h"
#include "symmetries/point_group/symmetry_search.h"
#include "symmetries/transformation_kind.h"

namespace symsurf {

namespace {

void run_symmetries(const Cloud& cloud, const ParameterValues& values, const Context& context,
                    AnalysisResult& result) {
  SymmetryOptions options;
  options.faces = cloud.faces;
  options.minimum_score = values.real("minimum_score");
  Symmetries found = find_symmetries(cloud.points, options, context);
  constexpr double rounding = 1e-6;  // radians and diagonals; the elements are a group to less
  for (const Matrix4& element : found.elements)
    result.transformations.push_back(
        {kind_of(element, found.centre, rounding, rounding * cloud.diagonal),
         element,
         found.score,
         {},
         {}});
  result.planes = std::move(found.planes);
  result.axes = std::move(found.axes);
  result.statistics = {{"group", found.group},
                       {"centre", found.centre},
                       {"inversion", found.inversion},
                       {"score", found.score},
                       {"missing", found.missing}};
}

}  // namespace

Symmetries find_symmetries(PointsView points, const SymmetryOptions& options,
                           const Context& context) {
  if (!(options.minimum_score >= 0 && options.minimum_score <= 1))
    throw InvalidParameter("minimum_score is " + to_string(Value(options.minimum_score)) +
                           "; allowed is [0, 1]");
  const auto start = std::chrono::steady_clock::now();
  Symmetries found;
  MethodImplementation searching;  // in place of the method
  searching.name = "symmetries";
  searching.preprocessing = Preprocessing::none();
  searching.preprocessing.remove_outliers = true;
  searching.preprocessing.sample_faces = true;
  searching.preprocessing.merge_duplicates = true;
  searching.run = [&](const Cloud& cloud, const ParameterValues&, const Context& running) {
    found = search_symmetries(cloud, options.faces.empty(), options.minimum_score, running);
    return Result{};
  };
  Cloud cloud;
  cloud.points = points;
  cloud.faces = options.faces;
  cloud.partition = Partition(points.size());
  run_pipeline(searching, {}, cloud, options.refuse_nonfinite, context);
  context.report(1);
  found.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return found;
}

AnalysisImplementation symmetries_analysis() {
  AnalysisImplementation analysis;
  analysis.name = "symmetries";
  analysis.title = "Symmetry group";
  analysis.summary =
      "Finds all symmetries of a shape: mirror planes, rotation axes, inversion, and their point "
      "group.";
  analysis.parameters = {Parameter::real("minimum_score", 0.7, 0, 1, "",
                                         "What the group must score for it to count.")};
  analysis.finds_elements = true;
  analysis.finds_transforms = true;
  analysis.run = run_symmetries;
  return analysis;
}

}  // namespace symsurf
