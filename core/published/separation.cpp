#include <symsurf/context.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <optional>

#include "base/linear_algebra.h"
#include "base/parallel.h"
#include "cloud/point_tree.h"
#include "cloud/surface_points.h"
#include "published.h"

namespace symsurf {

namespace {

double midpoint_score(const Cloud& cloud, const Result& result, const Context& context) {
  constexpr Index neighbours = 11, samples = 2000, grain = 64;
  const PointsView midpoints(result.surface_points);
  if (midpoints.size() < neighbours) return 0;
  const PointsView points = cloud.points;
  const double tolerance = surface_spacing(points, cloud.tree(context));
  if (!(tolerance > 0)) return 0;

  const PointTree midpoint_tree(midpoints, context.stage(0, 0.3));
  const Index stride = std::max<Index>(1, midpoints.size() / samples);
  const Index sampled = (midpoints.size() + stride - 1) / stride;
  const auto agreeing = [&](Index begin, Index end) {
    double sum = 0;
    std::vector<Neighbour> found;
    Eigen::Matrix<double, 3, neighbours - 1> others;
    for (Index k = begin; k < end; ++k) {
      const Index row = k * stride;
      midpoint_tree.nearest(midpoints[row], neighbours, found);
      // The nearest is the midpoint itself, or one equal to it.
      for (Index n = 1; n < neighbours; ++n) others.col(n - 1) = midpoints[found[n].index];
      const Vector3 mean = others.rowwise().mean();
      others.colwise() -= mean;
      const Vector3 normal = eigen_of(Matrix3(others * others.transpose())).vectors.col(0);
      const double off =
          std::hypot(result.residuals[row], 2 * normal.dot(midpoints[row] - mean)) / tolerance;
      const Vector3 chord = points[result.pairs(row, 0)] - points[result.pairs(row, 1)];
      const double moved = std::clamp(chord.norm() / 2 / tolerance - 1, 0.0, 1.0);
      sum += moved * std::exp(-off * off / 2);
    }
    return sum;
  };
  const double sum = parallel_sum(context.stage(0.3, 1), sampled, grain, 0.0, agreeing);

  std::vector<char> paired(points.size(), 0);
  for (const Index i : result.pairs.reshaped()) paired[i] = 1;
  const double covered = static_cast<double>(std::count(paired.begin(), paired.end(), 1)) /
                         static_cast<double>(points.size());
  return covered * sum / static_cast<double>(sampled);
}

// None where they lie on one line.
std::shared_ptr<Mirror> mirror_of(const Points& midpoints, const Context& context) {
  constexpr Index least = 12;
  if (midpoints.rows() < least) return nullptr;
  try {
    return fit_mirror(midpoints, "auto", std::nullopt, context);
  } catch (const InvalidInput&) {
    return nullptr;
  }
}

}  // namespace

Result midpoint_pairs(const Cloud& cloud, const std::vector<Neighbour>& partners,
                      const Context& context) {
  const PointsView points = cloud.points;
  const auto count = std::count_if(partners.begin(), partners.end(),
                                   [](const Neighbour& partner) { return partner.index >= 0; });
  Result result;
  result.pairs.resize(count, 2);
  result.residuals.resize(count);
  result.surface_points.resize(count, 3);
  for (Index i = 0, row = 0; i < points.size(); ++i) {
    const Neighbour& partner = partners[i];
    if (partner.index < 0) continue;
    result.pairs.row(row) << i, partner.index;
    result.residuals[row] = std::sqrt(partner.squared_distance);
    result.surface_points.row(row++) = (points[i] + points[partner.index]).transpose() / 2;
  }
  result.score = midpoint_score(cloud, result, context.stage(0, 0.8));
  result.mirror = mirror_of(result.surface_points, context.stage(0.8, 1));
  return result;
}

std::vector<Parameter> normal_parameters() {
  return {
      Parameter::integer("neighbours", 10, 3, 1000, "points",
                         "Number of nearest points, including the point itself, from which a "
                         "normal is estimated."),
      Parameter::choice(
          "normal_estimation", "regression", {"regression", "pca"},
          "How normals are estimated: by regression of z on x and y, as in the thesis, which fails "
          "on vertical patches, or by principal components (pca)."),
  };
}

Points given_or_estimated_normals(const Cloud& cloud, const ParameterValues& values,
                                  const Context& context) {
  if (cloud.normals.empty())
    return estimate_normals(cloud.points, cloud.tree(context), values.integer("neighbours"),
                            values.choice("normal_estimation"), context);
  Points unit(cloud.normals.size(), 3);
  for (Index i = 0; i < unit.rows(); ++i)
    unit.row(i) = cloud.normals[i].stableNormalized().transpose();
  return unit;
}

namespace {

// A cloud divided by a plane through its centroid, steps 3 to 9 of the thesis's Algorithms 1 and 2:
// X1 lies strictly above it, X2 is the rest.
struct Separation {
  // By index: of a point of X1 the point of X2 nearest to its line along the plane's normal, and
  // the squared distance from it; index -1 for points of X2, and for all where one side is empty.
  std::vector<Neighbour> partners;
  Index upper = 0, lower = 0;  // how many points X1 and X2 have

  bool is_upper(Index i) const { return partners[i].index >= 0; }
};

// Loops follow the tree's order, which keeps them in cache. Nearest to a line is nearest in the
// projection along it, where a tree of two dimensions finds it.
Separation separated(const Cloud& cloud, const PointTree& tree, const Vector3& centroid,
                     const Vector3& direction, const Context& context) {
  const PointsView points = cloud.points;
  const Vector3 across = direction.unitOrthogonal(), other = direction.cross(across);
  const auto projected = [&](Index i) {
    const Vector3 w = points[i] - centroid;
    return Eigen::Vector2d(across.dot(w), other.dot(w));
  };
  std::vector<std::int32_t> upper, lower;
  std::vector<Eigen::Vector2d> below;
  interruptible_for(context, points.size(), [&](Index p) {
    const std::int32_t i = tree.order()[p];
    const bool is_upper = (points[i] - centroid).dot(direction) > 0;
    (is_upper ? upper : lower).push_back(i);
    if (!is_upper) below.push_back(projected(i));
  });
  Separation result{std::vector<Neighbour>(points.size()), static_cast<Index>(upper.size()),
                    static_cast<Index>(lower.size())};
  if (upper.empty() || lower.empty()) return result;

  const KdTree<2> targets(std::move(below), context);
  Neighbour best{lower.front()};
  interruptible_for(context, result.upper, [&](Index k) {
    const Line line{points[upper[k]], direction, cloud.diagonal};
    best.squared_distance =
        line.squared_distance(points[best.index]);  // a guess: of the one before
    targets.search(projected(upper[k]), line.reach(best), [&](std::uint32_t target, double) {
      const std::int32_t b = lower[target];
      best = std::min(best, Neighbour{b, line.squared_distance(points[b])});
      return line.reach(best);
    });
    result.partners[upper[k]] = best;
  });
  return result;
}

// The shortest distance from any point to any midpoint (step 11). What is known of one midpoint
// spares its neighbours: distances from the cloud differ by no more than the midpoints lie apart.
double clearance(const Cloud& cloud, const PointTree& tree, const Separation& separation,
                 const Context& context) {
  std::vector<Vector3> midpoints;
  double shortest = std::numeric_limits<double>::infinity();
  interruptible_for(context, cloud.points.size(), [&](Index p) {
    const std::int32_t i = tree.order()[p];
    if (!separation.is_upper(i)) return;
    const Vector3 x = cloud.points[i];
    midpoints.push_back((x + cloud.points[separation.partners[i].index]) / 2);
    shortest = std::min(shortest, (x - midpoints.back()).norm());
  });
  Vector3 last = midpoints.front();
  double known = 0;  // no point is nearer to the last midpoint searched for
  // A few first: the sooner a short distance is known, the less there is to search. Looking 2 % of
  // the diagonal farther than needed spares over two thirds of the searches (10^5 points on two
  // surfaces).
  for (const Index stride : {Index{64}, Index{1}})
    interruptible_for(context, (separation.upper + stride - 1) / stride, [&](Index k) {
      const Vector3& midpoint = midpoints[k * stride];
      if (known - (midpoint - last).norm() > shortest * (1 + 1e-9)) return;
      const double reach = shortest + 0.02 * cloud.diagonal;
      const Neighbour found = tree.nearest(midpoint, reach * reach);
      last = midpoint;
      known = found.index < 0 ? reach : std::sqrt(found.squared_distance);
      shortest = std::min(shortest, known);
    });
  return shortest;
}

// Algorithm 1: the mean squared distance of the partners from their lines (3.3).
double line_error(const Separation& separation) {
  double sum = 0;
  for (const Neighbour& partner : separation.partners)
    if (partner.index >= 0) sum += partner.squared_distance;
  return sum / static_cast<double>(separation.upper);
}

// Algorithm 2: the mean squared distance of the partners from q, the point of X2 whose normal makes
// the smallest angle with that of x (3.5), the nearest on the unit sphere; equal angles: the lowest
// index. `order` of the normals keeps parallel ones together.
struct NormalError {
  PointsView points, normals;
  bool as_lines;  // the normals' sign does not count
  const std::vector<std::int32_t>& order;

  struct Parallel {
    double cosine;
    std::int32_t index;

    bool operator<(const Parallel& other) const {
      return cosine != other.cosine ? cosine > other.cosine : index < other.index;
    }
  };

  Parallel parallel(const Vector3& normal, std::int32_t i) const {
    const double c = normal.dot(normals[i]), size = as_lines ? std::abs(c) : c;
    return {size > 1 - 1e-15 ? 1 : size, i};  // within rounding of 1 the angle is 0
  }

  double operator()(const Separation& separation, const Context& context) const {
    // On a flat face all normals are as good as equal, and each query would have to look at each of
    // them. The tree has one of each group that lies within `radius`.
    constexpr double radius = 1e-8;
    std::vector<Vector3> centres;
    std::vector<std::int32_t> members;
    std::vector<std::size_t> begins;
    interruptible_for(context, points.size(), [&](Index p) {
      const std::int32_t i = order[p];
      if (separation.is_upper(i)) return;
      if (centres.empty() || (normals[i] - centres.back()).norm() > radius) {
        centres.push_back(normals[i]);
        begins.push_back(members.size());
      } else if (members.back() < i && normals[members.back()] == normals[i]) {
        return;  // of equal ones the first is the answer
      }
      members.push_back(i);
    });
    begins.push_back(members.size());
    for (std::size_t group = 0; group < centres.size(); ++group)
      std::sort(members.begin() + begins[group], members.begin() + begins[group + 1]);

    const KdTree<3> tree(std::move(centres), context);
    // The square of how far to look; 4e-15 is for the rounding of a cosine.
    const auto reach = [](const Parallel& best) {
      const double distance = std::sqrt(2 - 2 * best.cosine + 4e-15) + radius;
      return distance * distance;
    };
    Parallel best{0, members.front()};
    double sum = 0;
    interruptible_for(context, points.size(), [&](Index p) {
      const std::int32_t i = order[p];
      if (!separation.is_upper(i)) return;
      const Vector3 normal = normals[i];
      best = parallel(normal, best.index);  // a guess: of the one before
      const auto offer = [&](std::uint32_t group, double) {
        for (std::size_t k = begins[group]; k < begins[group + 1]; ++k) {
          const Parallel found = parallel(normal, members[k]);
          best = std::min(best, found);
          if (found.cosine == 1) break;  // no other of the group is better
        }
        return reach(best);
      };
      tree.search(normal, reach(best), offer);
      if (as_lines) tree.search(-normal, reach(best), offer);
      sum += (points[separation.partners[i].index] - points[best.index]).squaredNorm();
    });
    return sum / static_cast<double>(separation.upper);
  }
};

// The half sphere in the thesis's order of angles, the pole once.
std::vector<Vector3> directions(Index steps) {
  const double step = std::numbers::pi / static_cast<double>(steps);
  std::vector<Vector3> all{Vector3::UnitZ()};
  for (Index i = 1; i < steps; ++i)
    for (Index j = 0; j < steps; ++j) {
      const double phi = static_cast<double>(i) * step, theta = static_cast<double>(j) * step;
      all.emplace_back(std::sin(phi) * std::cos(theta), std::sin(phi) * std::sin(theta),
                       std::cos(phi));
    }
  return all;
}

// Algorithms 1 and 2: separates the cloud along each direction and keeps the one of the highest
// score s = ln(d + 1) + exp(-error) (3.4), d the clearance; equal scores: the first.
template <typename Error>
Result best_separation(const Cloud& cloud, Index steps, const Error& error,
                       const Context& context) {
  const PointTree& tree = cloud.tree(context.stage(0, 0.02));
  const std::vector<Vector3> tried = directions(steps);
  const auto count = static_cast<Index>(tried.size());
  Vector3 centroid = Vector3::Zero();
  for (Index i = 0; i < cloud.points.size(); ++i) centroid += cloud.points[i];
  centroid /= static_cast<double>(cloud.points.size());

  enum { projection_error = 3, shortest, score };
  Eigen::MatrixXd table(count, 8);
  parallel_for(context.stage(0, 0.95), count, 1, [&](Index k, Index) {
    const Separation trial = separated(cloud, tree, centroid, tried[k], context);
    double e = std::numeric_limits<double>::quiet_NaN(), d = e;
    if (trial.upper > 0 && trial.lower > 0) {
      e = error(trial, context);
      d = clearance(cloud, tree, trial, context);
    }
    table.row(k) << tried[k].transpose(), e, d, std::log(d + 1) + std::exp(-e),
        static_cast<double>(trial.upper), static_cast<double>(trial.lower);
  });

  Index best = -1;
  for (Index k = 0; k < count; ++k)
    if (!std::isnan(table(k, score)) && (best < 0 || table(k, score) > table(best, score)))
      best = k;
  if (best < 0)
    throw InvalidInput("each of the " + std::to_string(count) +
                       " planes tried leaves one side without points");
  const Separation winner = separated(cloud, tree, centroid, tried[best], context);
  Result result = midpoint_pairs(cloud, winner.partners, context.stage(0.95, 1));
  result.statistics = {
      {"direction", tried[best]},
      {"projection_error", table(best, projection_error)},
      {"clearance", table(best, shortest)},
      {"thesis_score", table(best, score)},
      {"directions", table},
      {"skipped_directions", static_cast<Index>(table.col(score).array().isNaN().count())}};
  return result;
}

Result run_separation(const Cloud& cloud, const ParameterValues& values, const Context& context) {
  Result result = best_separation(
      cloud, values.integer("steps"),
      [](const Separation& separation, const Context&) { return line_error(separation); }, context);
  result.method = "separation";
  return result;
}

Result run_separation_normals(const Cloud& cloud, const ParameterValues& values,
                              const Context& context) {
  const Points normals = given_or_estimated_normals(cloud, values, context.stage(0, 0.1));
  const PointTree normal_tree(normals, context.stage(0.1, 0.12));
  // Regression normals all point up, so their sign counts; others are lines.
  const bool as_lines =
      !cloud.normals.empty() || values.choice("normal_estimation") != "regression";
  const NormalError error{cloud.points, normals, as_lines, normal_tree.order()};
  Result result = best_separation(cloud, values.integer("steps"), error, context.stage(0.12, 1));
  result.method = "separation_normals";
  return result;
}

Parameter direction_steps() {
  return Parameter::integer(
      "steps", 10, 1, 1000, "",
      "Number of steps over 180 degrees in each of the two angles of the directions tried.");
}

}  // namespace

MethodImplementation separation_method() {
  MethodImplementation method;
  method.name = "separation";
  method.title = "Symmetry by separation (thesis, Algorithm 1)";
  method.summary =
      "Divides the cloud by planes through its centroid and maps one side onto the other along the "
      "normal; the score depends on the unit of the input.";
  method.parameters = {direction_steps()};
  method.preprocessing = Preprocessing::order_only();
  method.run = run_separation;
  return method;
}

MethodImplementation separation_normals_method() {
  MethodImplementation method;
  method.name = "separation_normals";
  method.title = "Symmetry by separation and normals (thesis, Algorithm 2)";
  method.summary =
      "Like separation, but scores a plane by the distance between the partner and the point with "
      "the most similar normal; the score depends on the unit of the input.";
  method.parameters = normal_parameters();
  method.parameters.insert(method.parameters.begin(), direction_steps());
  method.preprocessing = Preprocessing::order_only();
  method.run = run_separation_normals;
  return method;
}

namespace {

// Steps 2 to 6 of the thesis's Algorithm 3, by index: the other point nearest to the line through x
// along its unit normal; equal distances: the lowest index.
std::vector<Neighbour> nearest_to_normals(const Cloud& cloud, PointsView normals,
                                          const Context& context) {
  const PointsView points = cloud.points;
  const PointTree& tree = cloud.tree(context);
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
  const Points normals = given_or_estimated_normals(cloud, values, context.stage(0, 0.4));
  const std::vector<Neighbour> partners =
      nearest_to_normals(cloud, normals, context.stage(0.4, 0.9));
  Result result = midpoint_pairs(cloud, partners, context.stage(0.9, 1));
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
