#include <symsurf/analyses.h>
#include <symsurf/context.h>

#include <chrono>
#include <limits>
#include <optional>
#include <string>

#include "base/named_values.h"
#include "cloud/cloud.h"
#include "cloud/triangle_mesh.h"
#include "preprocess/preprocessing.h"
#include "symmetries/analysis.h"

namespace symsurf {

namespace {

const std::vector<AnalysisImplementation>& analysis_implementations() {
  static const std::vector<AnalysisImplementation> all{
      symmetries_analysis(),       partial_symmetries_analysis(), recurring_parts_analysis(),
      helical_symmetry_analysis(), symmetry_embedding_analysis(), intrinsic_symmetry_analysis(),
      match_pair_analysis()};
  return all;
}

const AnalysisImplementation& analysis_implementation(std::string_view name) {
  return find_named(analysis_implementations(), name, "analysis");
}

double absent(ParameterType type) {
  if (type == ParameterType::Integer) return -1;
  return type == ParameterType::Boolean ? 0 : std::numeric_limits<double>::quiet_NaN();
}

// The points of a shape that are finite, validated; `kept`: which of all, empty where all are.
struct FinitePoints {
  FinitePoints(Cloud& cloud, Index minimum_points, bool refuse_nonfinite, const Context& context)
      : removal(minimum_points, refuse_nonfinite) {
    const PointsView all = cloud.points;
    require_corners(cloud.faces, all.size());
    if (removal.apply(cloud, context))
      for (Index i = 0; i < all.size(); ++i)
        if (all[i].allFinite()) kept.push_back(i);
    validate(cloud, needed_points(cloud, minimum_points), context);
  }

  NonfiniteRemoval removal;
  std::vector<Index> kept;
};

// The numbers of finite points as those of all.
void renumber(Eigen::MatrixXd& rows, const std::vector<Index>& kept) {
  if (kept.empty()) return;
  rows = rows.unaryExpr(
      [&](double i) { return i < 0 ? i : static_cast<double>(kept[static_cast<Index>(i)]); });
}

// Makes the result of the finite points that of all.
void map_back(AnalysisResult& result, const Analysis& analysis, const std::vector<Index>& kept,
              const std::vector<Index>& kept_of_other, Index all) {
  for (const PointArray& array : analysis.arrays) {
    const auto found = result.arrays.find(array.name);
    if (found == result.arrays.end()) continue;
    Eigen::MatrixXd& rows = found->second;
    if (array.names_points) renumber(rows, kept);
    if (array.names_other) renumber(rows, kept_of_other);
    if (kept.empty()) continue;
    Eigen::MatrixXd full = Eigen::MatrixXd::Constant(all, rows.cols(), absent(array.type));
    full(kept, Eigen::indexing::all) = rows;
    rows = std::move(full);
  }
  if (kept.empty()) return;
  for (Transformation& transformation : result.transformations)
    for (std::vector<Index>* patch : {&transformation.from, &transformation.onto})
      for (Index& i : *patch) i = kept[i];
}

}  // namespace

const std::vector<Analysis>& analyses() {
  static const std::vector<Analysis> all(analysis_implementations().begin(),
                                         analysis_implementations().end());
  return all;
}

const Analysis& analysis(std::string_view name) { return analysis_implementation(name); }

AnalysisResult analyse(std::string_view name, PointsView points, const AnalysisOptions& options,
                       const Context& context) {
  const auto start = std::chrono::steady_clock::now();
  const AnalysisImplementation& analysis = analysis_implementation(name);
  const ParameterValues values(analysis.name, analysis.parameters, options.parameters);
  if (analysis.maximum_points > 0 && points.size() > analysis.maximum_points)
    throw InvalidInput(std::to_string(points.size()) + " points given; " + analysis.name +
                       " takes at most " + std::to_string(analysis.maximum_points));
  require_colours(points, options.colours);
  ColouredCloud cloud;
  cloud.points = points;
  cloud.faces = options.faces;
  cloud.colours = options.colours;
  const Context before = context.stage(0, 0);  // no progress worth telling
  const FinitePoints finite(cloud, analysis.minimum_points, options.refuse_nonfinite, before);
  const std::vector<Index>& kept = finite.kept;
  if (!kept.empty() && cloud.colours.size() > 0)
    cloud.colours = options.colours(kept, Eigen::indexing::all);
  if (analysis.takes_other == options.other.empty())
    throw InvalidInput(analysis.name +
                       (analysis.takes_other ? " needs a second shape" : " takes no second shape"));
  std::optional<FinitePoints> finite_other;
  if (analysis.takes_other) {
    cloud.other.points = options.other;
    cloud.other.faces = options.other_faces;
    finite_other.emplace(cloud.other, analysis.minimum_points, options.refuse_nonfinite, before);
  }

  AnalysisResult result;
  result.analysis = analysis.name;
  context.report(0);
  analysis.run(cloud, values, context, result);
  drop_nonfinite(result.statistics);
  result.footprint = std::make_shared<const Points>(footprint_of(cloud));
  for (Plane& plane : result.planes) plane.set_footprint(result.footprint);
  map_back(result, analysis, kept, finite_other ? finite_other->kept : kept, points.size());
  if (!kept.empty()) result.statistics["nonfinite_points"] = points.size() - cloud.points.size();
  result.parameters = values.all();
  context.report(1);
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return result;
}

}  // namespace symsurf
