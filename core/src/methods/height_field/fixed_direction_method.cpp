#include <symsurf/height_field.h>

#include "base/parallel.h"
#include "methods/common_parameters.h"
#include "methods/height_field/consistent_pairs.h"
#include "methods/height_field/field_search.h"
#include "methods/registry.h"
#include "score/matching.h"
#include "score/mirror_score.h"

namespace symsurf {

namespace {

Points framed(const Cloud& cloud, const Context& context) {
  Points points(cloud.points.size(), 3);
  parallel_for(context, points.rows(), 1 << 14, [&](Index begin, Index end) {
    for (Index i = begin; i < end; ++i)
      points.row(i) = cloud.frame.to_frame(cloud.points[i]).transpose();
  });
  return points;
}

Result run_fixed_direction(const Cloud& cloud, const ParameterValues& values,
                           const Context& context) {
  Result result;
  result.method = "fixed_direction";
  const PrincipalFrame& frame = cloud.frame;
  const WorkingCloud work(framed(cloud, context.stage(0, 0.05)), values.integer("sample_size"),
                          context.stage(0.05, 0.1));
  const Vector3 given = frame.axes.transpose() * values.vector("direction");
  const FieldEstimate found =
      find_height_field(work, given, result.statistics, context.stage(0.1, 0.7));
  if (found.nodes.rows() == 0) return result;

  const HeightField field(found.direction, found.nodes);
  result.mirror = field.transformed(frame.size, frame.axes, frame.centroid);
  PointTree tree(cloud.points, context.stage(0.7, 0.75));
  const NearestPoints points(cloud.points, tree, context);
  MirrorScore(cloud, points, context.stage(0.75, 0.8)).fill(result);
  add_pairs(result, cloud.points, std::move(tree), *result.mirror,
            values.real("pair_distance") * cloud.diagonal, context.stage(0.8, 0.9));
  result.surface_points = result.mirror->project(result.surface_points, context.stage(0.9, 0.95));
  const double working_share =
      static_cast<double>(work.size()) / static_cast<double>(cloud.partition.total());
  keep_credible_pairs(result, work.spacing * std::sqrt(working_share) * frame.size,
                      context.stage(0.95, 1));
  return result;
}

}  // namespace

MethodImplementation fixed_direction_method() {
  MethodImplementation method;
  method.name = "fixed_direction";
  method.title = "Curved mirror, fixed direction";
  method.summary =
      "Finds a curved mirror that maps all points along one direction, wherever that points and "
      "whether or not a plane separates the sides.";
  method.parameters = {
      Parameter::direction("direction",
                           "The direction of mapping, if known to a degree; (0, 0, 0) searches."),
      Parameter::integer("sample_size", 5000, 100, 100000, "points",
                         "Points that the search works on."),
      pair_distance(),
  };
  method.minimum_points = 20;
  method.preprocessing.extract_boundary = false;
  method.run = run_fixed_direction;
  return method;
}

}  // namespace symsurf
