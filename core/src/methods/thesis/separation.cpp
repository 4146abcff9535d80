#include "methods/thesis/separation.h"

#include <symsurf/errors.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "base/parallel.h"
#include "methods/thesis/lines.h"
#include "methods/thesis/midpoint_score.h"
#include "spatial/kd_tree.h"

namespace symsurf {

namespace {

// Unit normals in the thesis's order of angles, the pole once.
std::vector<Vector3> half_sphere(Index steps) {
  const double step = std::numbers::pi / static_cast<double>(steps);
  std::vector<Vector3> directions{Vector3::UnitZ()};
  for (Index i = 1; i < steps; ++i)
    for (Index j = 0; j < steps; ++j) {
      const double phi = static_cast<double>(i) * step, theta = static_cast<double>(j) * step;
      directions.emplace_back(std::sin(phi) * std::cos(theta), std::sin(phi) * std::sin(theta),
                              std::cos(phi));
    }
  return directions;
}

Vector3 centroid_of(PointsView points) {
  Vector3 sum = Vector3::Zero();
  for (Index i = 0; i < points.size(); ++i) sum += points[i];
  return sum / static_cast<double>(points.size());
}

// Along the tree's order all loops stay in cache. Nearest to a line is nearest
// in the projection along it, where a tree of two dimensions finds it.
Separation separated(const Cloud& cloud, const PointTree& tree, const Vector3& centroid,
                     const Vector3& direction, const Context& context) {
  const PointsView points = cloud.points;
  const Vector3 across = direction.unitOrthogonal(), other = direction.cross(across);
  const auto projected = [&](Index i) {
    const Vector3 w = points[i] - centroid;
    return Eigen::Vector2d(across.dot(w), other.dot(w));
  };
  Separation result;
  result.partner.assign(points.size(), -1);
  result.squared.resize(points.size());
  std::vector<std::int32_t> upper, lower;
  std::vector<Eigen::Vector2d> below;
  interruptible_for(context, points.size(), [&](Index p) {
    const std::int32_t i = tree.order()[p];
    const bool is_upper = (points[i] - centroid).dot(direction) > 0;
    (is_upper ? upper : lower).push_back(i);
    if (!is_upper) below.push_back(projected(i));
  });
  result.upper = static_cast<Index>(upper.size());
  result.lower = static_cast<Index>(lower.size());
  if (upper.empty() || lower.empty()) return result;

  const KdTree<2> targets(std::move(below), context);
  Neighbour best{lower.front()};
  interruptible_for(context, result.upper, [&](Index k) {
    const std::int32_t i = upper[k];
    const Line line{points[i], direction, cloud.diagonal};
    best.squared_distance =
        line.squared_distance(points[best.index]);  // of the one before: a guess
    targets.search(projected(i), line.reach(best), [&](std::uint32_t target) {
      const std::int32_t b = lower[target];
      best = std::min(best, Neighbour{b, line.squared_distance(points[b])});
      return line.reach(best);
    });
    result.partner[i] = static_cast<std::int32_t>(best.index);
    result.squared[i] = best.squared_distance;
  });
  return result;
}

// The shortest distance from any point to any midpoint (step 11). What is known
// of one midpoint spares its neighbours: distances from the cloud differ by no
// more than the midpoints lie apart.
double clearance(PointsView points, const PointTree& tree, const Separation& separation,
                 const Context& context) {
  std::vector<Vector3> midpoints;
  double shortest = std::numeric_limits<double>::infinity();
  interruptible_for(context, points.size(), [&](Index p) {
    const std::int32_t i = tree.order()[p], b = separation.partner[i];
    if (b < 0) return;
    midpoints.push_back((points[i] + points[b]) / 2);
    shortest = std::min(shortest, (points[i] - midpoints.back()).norm());
  });
  Vector3 last = midpoints.front();
  double known = 0;  // no point is nearer to the last midpoint searched for
  interruptible_for(context, separation.upper, [&](Index k) {
    if (known - (midpoints[k] - last).norm() > shortest * (1 + 1e-9)) return;
    const double reach = 1.25 * shortest;
    const Neighbour found = tree.nearest(midpoints[k], reach * reach);
    last = midpoints[k];
    known = found.index < 0 ? reach : std::sqrt(found.squared_distance);
    shortest = std::min(shortest, known);
  });
  return shortest;
}

void add_pairs(Result& result, PointsView points, const Separation& separation) {
  result.pairs.resize(separation.upper, 2);
  result.residuals.resize(separation.upper);
  result.surface_points.resize(separation.upper, 3);
  for (Index i = 0, row = 0; i < points.size(); ++i) {
    const Index b = separation.partner[i];
    if (b < 0) continue;
    result.pairs.row(row) << i, b;
    result.residuals[row] = std::sqrt(separation.squared[i]);
    result.surface_points.row(row++) = (points[i] + points[b]).transpose() / 2;
  }
}

}  // namespace

Result best_separation(const Cloud& cloud, const PointTree& tree, Index steps,
                       const ProjectionError& error, const Context& context) {
  const std::vector<Vector3> directions = half_sphere(steps);
  const auto count = static_cast<Index>(directions.size());
  const Vector3 centroid = centroid_of(cloud.points);
  enum Column { x, y, z, projection_error, clear, score, upper, lower, columns };
  Eigen::MatrixXd table(count, static_cast<Index>(columns));
  parallel_for(context.stage(0, 0.95), count, 1, [&](Index k, Index) {
    const Separation trial = separated(cloud, tree, centroid, directions[k], context);
    double e = std::numeric_limits<double>::quiet_NaN(), d = e;
    if (trial.upper > 0 && trial.lower > 0) {
      e = error(trial, context);
      d = clearance(cloud.points, tree, trial, context);
    }
    table.row(k) << directions[k].transpose(), e, d, std::log(d + 1) + std::exp(-e),
        static_cast<double>(trial.upper), static_cast<double>(trial.lower);
  });

  Index best = -1, skipped = 0;
  for (Index k = 0; k < count; ++k) {
    if (std::isnan(table(k, score)))
      ++skipped;
    else if (best < 0 || table(k, score) > table(best, score))
      best = k;
  }
  if (best < 0)
    throw InvalidInput("each of the " + std::to_string(count) +
                       " planes tried leaves one side without points");

  Result result;
  add_pairs(result, cloud.points, separated(cloud, tree, centroid, directions[best], context));
  result.score = midpoint_score(cloud.points, tree, result, context.stage(0.95, 1));
  result.statistics = {{"direction", directions[best]},
                       {"projection_error", table(best, projection_error)},
                       {"clearance", table(best, clear)},
                       {"thesis_score", table(best, score)},
                       {"directions", table},
                       {"skipped_directions", skipped}};
  return result;
}

Parameter direction_steps() {
  return Parameter::integer("steps", 10, 1, 1000, "",
                            "Steps over half a turn in each of the two angles of the directions "
                            "tried.");
}

}  // namespace symsurf
