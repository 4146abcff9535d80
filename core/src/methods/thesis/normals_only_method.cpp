#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "methods/registry.h"
#include "methods/thesis/estimated_normals.h"
#include "methods/thesis/lines.h"
#include "methods/thesis/midpoint_score.h"
#include "spatial/kd_tree.h"

namespace symsurf {

namespace {

// Steps 2 to 6 of the thesis's Algorithm 3: for each point x the other point
// nearest to the line through x along its unit normal (equal distances: the
// lowest index), by branch and bound over boxes. One pair a point, mutual ones
// twice.
Result pairs_along_normals(const Cloud& cloud, const PointTree& order, PointsView normals,
                           const Context& context) {
  constexpr Index grain = 1024;
  const PointsView points = cloud.points;
  std::vector<Vector3> sorted;
  interruptible_for(context, points.size(),
                    [&](Index p) { sorted.push_back(points[order.order()[p]]); });
  const KdTree<3> tree(std::move(sorted), context);
  Result result;
  result.pairs.resize(points.size(), 2);
  result.residuals.resize(points.size());
  result.surface_points.resize(points.size(), 3);
  parallel_for(context, points.size(), grain, [&](Index begin, Index end) {
    Neighbour best;
    for (Index p = begin; p < end; ++p) {
      const std::int32_t i = order.order()[p];
      const Line line{points[i], normals[i], cloud.diagonal};
      // The partner of the one before is a guess.
      best = best.index < 0 || best.index == i
                 ? Neighbour{}
                 : Neighbour{best.index, line.squared_distance(points[best.index])};
      const Vector3 across = normals[i].unitOrthogonal(), other = normals[i].cross(across);
      const auto squared = [&](const Vector3& centre, const Vector3& half) {
        // No box lies nearer to the line than its projections on two axes.
        const Vector3 w = centre - line.start;
        const auto outside = [&](const Vector3& axis) {
          return std::max(0.0, std::abs(axis.dot(w)) - axis.cwiseAbs().dot(half));
        };
        const double x = outside(across), y = outside(other);
        return x * x + y * y;
      };
      tree.search_boxes(squared, line.reach(best), [&](std::uint32_t position) {
        const std::int32_t b = order.order()[position];
        if (b != i) best = std::min(best, Neighbour{b, line.squared_distance(points[b])});
        return line.reach(best);
      });
      result.pairs.row(i) << i, best.index;
      result.residuals[i] = std::sqrt(best.squared_distance);
      result.surface_points.row(i) = (points[i] + points[best.index]).transpose() / 2;
    }
  });
  return result;
}

Result run_normals_only(const Cloud& cloud, const ParameterValues& values, const Context& context) {
  const PointTree tree(cloud.points, context.stage(0, 0.05));
  const Points normals = given_or_estimated_normals(cloud, tree, values, context.stage(0.05, 0.4));
  Result result = pairs_along_normals(cloud, tree, normals, context.stage(0.4, 0.9));
  result.method = "normals_only";
  result.score = midpoint_score(cloud.points, tree, result, context.stage(0.9, 1));
  result.statistics["projection_error"] =
      result.residuals.squaredNorm() / static_cast<double>(result.residuals.size());
  return result;
}

}  // namespace

MethodImplementation normals_only_method() {
  MethodImplementation method;
  method.name = "normals_only";
  method.title = "Symmetry by normals (thesis, Algorithm 3)";
  method.summary =
      "Pairs each point with the point nearest to the line along "
      "its normal: for two sheets at a "
      "constant distance.";
  method.parameters = normal_parameters();
  method.preprocessing = Preprocessing::none();
  method.run = run_normals_only;
  return method;
}

}  // namespace symsurf
