#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "midpoint_pairs.h"
#include "search/registry.h"

namespace symsurf {

namespace {

// Steps 2 to 6 of the thesis's Algorithm 3, by index: the other point nearest to the line through x
// along its unit normal; equal distances: the lowest index.
std::vector<Neighbour> nearest_to_normals(const Cloud& cloud, const PointTree& tree,
                                          PointsView normals, const Context& context) {
  const PointsView points = cloud.points;
  std::vector<Neighbour> partners(points.size());
  constexpr Index grain = 1024;
  parallel_for(context, points.size(), grain, [&](Index begin, Index end) {
    Neighbour best;
    for (Index p = begin; p < end; ++p) {
      const std::int32_t i = tree.order()[p];
      const Line line{points[i], normals[i], cloud.diagonal};
      const Vector3 across = normals[i].unitOrthogonal(), other = normals[i].cross(across);
      // No box lies nearer to the line than its projections on two axes.
      const auto bound = [&](const Vector3& low, const Vector3& high) {
        const Vector3 half = (high - low) / 2, centre = low + half - line.start;
        const auto outside = [&](const Vector3& axis) {
          return std::max(0.0, std::abs(axis.dot(centre)) - axis.cwiseAbs().dot(half));
        };
        const double x = outside(across), y = outside(other);
        return x * x + y * y;
      };
      // The partner of the one before is a guess.
      if (best.index == i) best = {};
      if (best.index >= 0) best.squared_distance = line.squared_distance(points[best.index]);
      tree.search_boxes(bound, line.reach(best), [&](Index b) {
        if (b != i) best = std::min(best, Neighbour{b, line.squared_distance(points[b])});
        return line.reach(best);
      });
      partners[i] = best;
    }
  });
  return partners;
}

Result run_normals_only(const Cloud& cloud, const ParameterValues& values, const Context& context) {
  const PointTree tree(cloud.points, context.stage(0, 0.05));
  const Points normals = given_or_estimated_normals(cloud, tree, values, context.stage(0.05, 0.4));
  const std::vector<Neighbour> partners =
      nearest_to_normals(cloud, tree, normals, context.stage(0.4, 0.9));
  Result result = midpoint_pairs(cloud.points, tree, partners, context.stage(0.9, 1));
  result.method = "normals_only";
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
      "Pairs each point with the point nearest to the line along its normal: for two surfaces at a "
      "constant distance.";
  method.parameters = normal_parameters();
  method.preprocessing = Preprocessing::order_only();
  method.run = run_normals_only;
  return method;
}

}  // namespace symsurf
