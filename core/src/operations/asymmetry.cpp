#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "base/math.h"
#include "base/parallel.h"
#include "operations/counterparts.h"
#include "operations/operation_registry.h"
#include "operations/sides.h"

namespace symsurf {

namespace {

// In units and in shares of the diagonal: none is compared between shapes without knowing its unit.
void report_length(Values& statistics, const std::string& name, double length, double diagonal) {
  statistics[name] = length;
  statistics[name + "_of_diagonal"] = length / diagonal;
}

void report_distances(Values& statistics, const Eigen::VectorXd& distance,
                      const Eigen::VectorXd& signed_distance, double diagonal,
                      const Context& context) {
  std::vector<double> lengths;
  double sum = 0, squares = 0, signed_sum = 0, signed_squares = 0;
  interruptible_for(context, distance.size(), [&](Index i) {
    if (!std::isfinite(distance[i])) return;
    lengths.push_back(distance[i]);
    sum += distance[i];
    squares += distance[i] * distance[i];
    signed_sum += signed_distance[i];
    signed_squares += signed_distance[i] * signed_distance[i];
  });
  if (lengths.empty()) return;
  const auto count = static_cast<double>(lengths.size());
  const double mean = signed_sum / count;
  report_length(statistics, "mean", sum / count, diagonal);
  report_length(statistics, "rms", std::sqrt(squares / count), diagonal);
  const std::pair<const char*, double> quantiles[]{
      {"median", 0.5}, {"p75", 0.75}, {"p95", 0.95}, {"p99", 0.99}};
  for (const auto& [name, share] : quantiles) {
    context.check();
    report_length(statistics, name, quantile(lengths, share), diagonal);
  }
  report_length(statistics, "maximum", *std::max_element(lengths.begin(), lengths.end()), diagonal);
  report_length(statistics, "signed_mean", mean, diagonal);
  report_length(statistics, "signed_deviation",
                std::sqrt(std::max(0.0, signed_squares / count - mean * mean)), diagonal);
}

void report_sides(Values& statistics, const OperationInput& input, const Mirror& mirror,
                  bool is_watertight, const Context& context) {
  const Sides sides = measured_sides(input.points, input.faces, mirror, context);
  statistics["positive_area"] = sides.positive_area;
  statistics["negative_area"] = sides.negative_area;
  statistics["area_index"] = Sides::index(sides.positive_area, sides.negative_area);
  if (!is_watertight) return;
  // Of a mesh that is wound inwards both are negative.
  statistics["positive_volume"] = std::abs(sides.positive_volume);
  statistics["negative_volume"] = std::abs(sides.negative_volume);
  statistics["volume_index"] =
      Sides::index(std::abs(sides.positive_volume), std::abs(sides.negative_volume));
}

void run_asymmetry(const OperationInput& input, const Mirror& mirror, const ParameterValues& values,
                   const Context& context, OperationResult& result) {
  const PointsView points = input.points;
  const Index count = points.size();
  const double diagonal = diagonal_of(points);
  const Counterparts counterparts(input, mirror, limits_of(values, points), context.stage(0, 0.8));
  Points vector(count, 3);
  Eigen::VectorXd distance(count), outward(count), lateral(count), matched(count);
  interruptible_for(context, count, [&](Index i) {
    const Counterpart& counterpart = counterparts[i];
    const Vector3 x = points[i];
    const Vector3 to_place = (counterpart.matched ? counterpart.place : Counterpart::nowhere) - x;
    const Vector3 from_mirror = x - counterparts.image(i);  // twice as far
    vector.row(i) = to_place.transpose();
    distance[i] = to_place.norm();
    outward[i] = to_place.dot(counterparts.normals().row(i).transpose());
    lateral[i] = to_place.dot(from_mirror.stableNormalized());
    matched[i] = counterpart.matched ? 1 : 0;
  });
  Values& statistics = result.statistics;
  statistics["matched_share"] =
      static_cast<double>(counterparts.matched()) / static_cast<double>(count);
  counterparts.report_unmatched(statistics);
  statistics["diagonal"] = diagonal;
  report_distances(statistics, distance, outward, diagonal, context);
  if (!input.faces.empty())
    report_sides(statistics, input, mirror, counterparts.is_watertight(), context.stage(0.8, 1));
  result.arrays = {{"vector", vector},
                   {"distance", distance},
                   {"signed", outward},
                   {"lateral", lateral},
                   {"matched", matched}};
}

}  // namespace

OperationImplementation asymmetry_operation() {
  OperationImplementation operation;
  operation.name = "asymmetry";
  operation.title = "Mirror asymmetry";
  operation.summary =
      "Measures for each point how far it is from where the other side says it should be: the "
      "closest point of the mirrored surface.";
  operation.parameters = {max_distance(), max_angle()};
  operation.arrays = {
      {"vector", ParameterType::Real, 3,
       "From the point to its place, input units; NaN without a counterpart."},
      {"distance", ParameterType::Real, 1, "Its length, input units."},
      {"signed", ParameterType::Real, 1,
       "Its part along the outward normal, input units: positive where the point lies too far in.",
       true},
      {"lateral", ParameterType::Real, 1, "Its part away from the mirror, input units.", true},
      {"matched", ParameterType::Boolean, 1,
       "Whether the point has a counterpart: none past a rim, too far away, or with another "
       "normal."},
  };
  operation.shown = "signed";
  operation.run = run_asymmetry;
  return operation;
}

}  // namespace symsurf
