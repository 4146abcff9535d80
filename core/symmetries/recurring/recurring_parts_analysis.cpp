#include <algorithm>
#include <numbers>
#include <optional>

#include "analysis_registry.h"
#include "base/math.h"
#include "cloud/closest_point_on_mesh.h"
#include "preprocess/boundary.h"
#include "recurring/cloud_facets.h"
#include "recurring/part_points.h"
#include "recurring/recurring_part.h"

namespace symsurf {

namespace {

// Standard deviations of the noise: what the ends of two lines may be apart for it.
constexpr double beyond_noise = 4;

// Of that: the mean length of a part's lines. Shorter ones, as of skulls, agree by chance.
constexpr double longer_than_noise = 5;

// Radians, and of how far it moves a part: what a map may miss the symmetry by that it is named
// after.
constexpr double named_angle = 0.02, named_share = 0.1;

void run_recurring_parts(const ColouredCloud& cloud, const ParameterValues& values,
                         const Context& context, AnalysisResult& result) {
  // In diagonals, from the centroid.
  Points scaled = cloud.points.matrix();
  scaled.rowwise() -= cloud.frame.centroid.transpose();
  scaled /= cloud.diagonal;
  const double angle = values.real("feature_angle") * std::numbers::pi / 180;
  std::optional<CloudFacets> facets;
  FeatureLines graph;
  if (!cloud.faces.empty()) {
    graph = feature_lines(scaled, cloud.faces, angle, context.stage(0, 0.2));
  } else if (!is_volumetric(cloud, context.stage(0, 0.02))) {  // within a body facets are chance
    facets.emplace(scaled, context.stage(0.02, 0.1));
    graph = feature_lines(*facets, angle, context.stage(0.1, 0.2));
  }
  const double tolerance = std::max(values.real("tolerance"), beyond_noise * graph.noise);
  std::vector<RecurringPart> parts =
      part_search(graph, tolerance, values.integer("count"), context.stage(0.2, 0.8));
  std::erase_if(parts, [&](const RecurringPart& part) {
    return static_cast<Index>(part.instances.size()) < values.integer("minimum_instances") ||
           part.length < longer_than_noise * beyond_noise * graph.noise *
                             static_cast<double>(part.lines.size());
  });
  std::optional<ClosestPointOnMesh> closest;
  if (!cloud.faces.empty()) closest.emplace(scaled, cloud.faces, context.stage(0.8, 0.9));
  const auto to_surface = [&](const Vector3& x) {
    if (facets) return facets->squared_distance(x);
    const ClosestPoint nearest = (*closest)(x, 4 * tolerance * tolerance);
    return nearest.face < 0 ? infinity : nearest.squared_distance;
  };
  const PartPoints points =
      part_points(scaled, graph, parts, tolerance, to_surface, context.stage(0.9, 1));

  const Index count = cloud.points.size();
  Eigen::VectorXd part(count), instance(count);
  for (Index i = 0; i < count; ++i) {
    part[i] = static_cast<double>(points.part[i]);
    instance[i] = static_cast<double>(points.instance[i]);
  }
  for (std::size_t p = 0; p < parts.size(); ++p) {
    const Vector3 middle =
        cloud.points.matrix()(points.members[p][0], Eigen::indexing::all).colwise().mean();
    for (std::size_t k = 0; k < parts[p].instances.size(); ++k) {
      Transformation transformation;
      Eigen::Isometry3d map = parts[p].instances[k].map;
      map.translation() *= cloud.diagonal;
      const Eigen::Translation3d from_centroid(cloud.frame.centroid);
      transformation.matrix = (from_centroid * map * from_centroid.inverse()).matrix();
      const Vector3 moved = (transformation.matrix * middle.homogeneous()).head<3>() - middle;
      // But the first none is the identity, however little it moves.
      transformation.kind =
          k == 0 ? "identity"
                 : kind_of(transformation.matrix, middle, named_angle,
                           std::min(tolerance * cloud.diagonal, named_share * moved.norm()));
      transformation.score = points.scores[p][k];
      transformation.from = points.members[p][0];
      transformation.onto = points.members[p][k];
      result.transformations.push_back(std::move(transformation));
    }
  }
  result.arrays = {{"part", part}, {"instance", instance}};
  result.statistics["parts"] = static_cast<Index>(parts.size());
  result.statistics["instances"] = static_cast<Index>(result.transformations.size());
  result.statistics["noise"] = graph.noise * cloud.diagonal;
  result.statistics["feature_lines"] = static_cast<Index>(graph.lines.size());
}

}  // namespace

AnalysisImplementation recurring_parts_analysis() {
  AnalysisImplementation analysis;
  analysis.name = "recurring_parts";
  analysis.title = "Recurring parts";
  analysis.summary =
      "Finds the parts of a mesh or cloud that recur, such as windows or teeth, by its feature "
      "lines (Bokeloh et al. 2009).";
  analysis.parameters = {
      Parameter::real("feature_angle", 30, 1, 179, "degrees",
                      "Facets that meet at more than this angle have a feature line between them."),
      Parameter::real("tolerance", 0.002, 1e-6, 0.1, "diagonal",
                      "How far an instance may differ from another."),
      Parameter::integer("minimum_instances", 2, 2, 1000000, "", "How often a part must occur."),
      Parameter::integer("count", 20, 1, 1000, "", "The most parts that are found."),
  };
  analysis.arrays = {
      {"part", ParameterType::Integer, 1, "The part that the point belongs to, -1: none."},
      {"instance", ParameterType::Integer, 1, "Its instance of that part, -1: none."},
  };
  analysis.shown = "instance";
  analysis.finds_transforms = true;
  analysis.run = run_recurring_parts;
  return analysis;
}

}  // namespace symsurf
