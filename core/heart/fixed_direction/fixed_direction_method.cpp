#include <symsurf/mirrors.h>

#include <algorithm>

#include "base/math.h"
#include "base/parallel.h"
#include "fixed_direction/field_search.h"
#include "pairing/matching.h"
#include "score/mirror_score.h"
#include "search/registry.h"

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

constexpr double far_residual = 6;      // median residuals: a partner by chance
constexpr double far_at_least = 1e-6;   // spacings
constexpr Index known_neighbours = 16;  // both ends of a pair share a surface point
constexpr double near = 2;              // spacings: an image's neighbour
constexpr double one_sided = 0.5;

// Between exact pairs the surface is known; beyond them, as at a hole's rim, it is a guess.
bool surrounded(const Vector3& x, const Points& known, const PointTree& tree,
                std::vector<Neighbour>& found) {
  tree.nearest(x, known_neighbours, found);
  Vector3 pull = Vector3::Zero();
  for (const Neighbour& n : found) {
    const Vector3 way = known.row(n.index).transpose() - x;
    if (way.norm() > 0) pull += way.normalized();
  }
  return pull.norm() < one_sided * static_cast<double>(found.size());
}

// Drops pairs by chance: where one side is missing, images fall on whatever lies at the gap's rim.
// Kept is what fits about as well as most pairs do and, where most are exact, neighbours of an
// image among exact pairs. `spacing`: of the points on a surface, in input units.
void keep_consistent_pairs(Result& result, double spacing, const Context& context) {
  const Eigen::VectorXd& residuals = result.residuals;
  if (residuals.size() == 0) return;
  const double typical = median(std::vector(residuals.begin(), residuals.end()));
  const double limit = std::max(far_residual * typical, far_at_least * spacing);
  std::vector<Index> consistent, doubtful;
  for (Index i = 0; i < residuals.size(); ++i) {
    if (residuals[i] <= limit)
      consistent.push_back(i);
    else if (residuals[i] <= near * spacing)
      doubtful.push_back(i);
  }
  if (!doubtful.empty()) {
    const Points known = result.surface_points(consistent, Eigen::indexing::all);
    const PointTree tree(known, context.stage(0, 0.5));
    std::vector<char> kept(doubtful.size());
    parallel_for(context.stage(0.5, 1), kept.size(), 1 << 10, [&](Index begin, Index end) {
      std::vector<Neighbour> found;
      for (Index k = begin; k < end; ++k)
        kept[k] = surrounded(result.surface_points.row(doubtful[k]), known, tree, found);
    });
    for (std::size_t k = 0; k < kept.size(); ++k)
      if (kept[k]) consistent.push_back(doubtful[k]);
    std::sort(consistent.begin(), consistent.end());
  }
  keep_pairs(result, consistent);
}

Result run_fixed_direction(const Cloud& cloud, const ParameterValues& values,
                           const Context& context) {
  Result result;
  result.method = "fixed_direction";
  const PrincipalFrame& frame = cloud.frame;
  const SurfacePoints work(framed(cloud, context.stage(0, 0.05)), values.integer("sample_size"),
                           context.stage(0.05, 0.1));
  const Vector3 given = frame.axes.transpose() * values.vector("direction");
  const FieldEstimate found =
      find_height_field(work, given, result.statistics, context.stage(0.1, 0.7));
  if (found.nodes.rows() == 0) return result;

  // Not by transformed(): what a height field knows of its nodes takes time to make.
  Points nodes = frame.size * (found.nodes * frame.axes.transpose());
  nodes.rowwise() += frame.centroid.transpose();
  result.mirror =
      std::make_shared<HeightField>(frame.axes * found.direction, std::move(nodes), context);
  PointTree tree(cloud.points, context.stage(0.7, 0.75));
  const NearestPoints points(cloud.points, tree, context);
  MirrorScore(cloud, points, context.stage(0.75, 0.8)).fill(result);
  add_pairs(result, cloud, std::move(tree), values, context.stage(0.8, 0.9));
  result.surface_points = result.mirror->project(result.surface_points, context.stage(0.9, 0.95));
  const double working_share =
      static_cast<double>(work.size()) / static_cast<double>(cloud.points.size());
  keep_consistent_pairs(result, work.spacing * std::sqrt(working_share) * frame.size,
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
