#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "base/math.h"
#include "base/parallel.h"
#include "operations/counterparts.h"
#include "operations/operation.h"

namespace symsurf {

namespace {

// What a mesh has on the two sides of a mirror, square and cubic input units. Faces that the
// mirror cuts count in part.
struct Sides {
  double positive_area = 0, negative_area = 0;
  double positive_volume = 0, negative_volume = 0;  // of a watertight mesh, else meaningless

  // (positive - negative) / (positive + negative), -1 to 1; 0: symmetric.
  static double index(double positive, double negative) {
    return (positive - negative) / (positive + negative);
  }
};

struct Corner {
  Vector3 x, foot;
  double distance;
};

// The volume under a triangle down to the triangle of its feet. The walls between neighbours
// cancel, and at the mirror they have no height, so that they need not be added: divergence
// theorem.
void add_triangle(const Corner& a, const Corner& b, const Corner& c, double& area, double& volume) {
  area += (b.x - a.x).cross(c.x - a.x).norm() / 2;
  volume += (a.x.cross(b.x).dot(c.x) - a.foot.cross(b.foot).dot(c.foot)) / 6;
}

// Where an edge meets the mirror, to the first order in the distances.
Corner crossing(const Corner& a, const Corner& b) {
  const double t = a.distance / (a.distance - b.distance);
  const Vector3 x = a.x + t * (b.x - a.x);
  return {x, x, 0};
}

// The corner apart from the two others: a triangle on its side, a quadrangle on theirs.
void add_cut(const Corner& apart, const Corner& b, const Corner& c, Sides& sides) {
  const Corner at_b = crossing(apart, b), at_c = crossing(apart, c);
  const bool positive = apart.distance > 0;
  double& area = positive ? sides.positive_area : sides.negative_area;
  double& volume = positive ? sides.positive_volume : sides.negative_volume;
  double& other_area = positive ? sides.negative_area : sides.positive_area;
  double& other_volume = positive ? sides.negative_volume : sides.positive_volume;
  add_triangle(apart, at_b, at_c, area, volume);
  add_triangle(at_b, b, c, other_area, other_volume);
  add_triangle(at_b, c, at_c, other_area, other_volume);
}

// The volume between the faces of a side and their feet on the mirror. For a mirror that bends,
// the feet of a face are taken for a triangle. Where points have no foot, NaN.
Sides measured_sides(PointsView points, TrianglesView faces, const Mirror& mirror,
                     const Context& context) {
  const Eigen::VectorXd distances = mirror.signed_distance(points, context.stage(0, 0.5));
  const Points feet = mirror.project(points, context.stage(0.5, 1));
  const Vector3 origin = points[0];
  Sides sides;
  interruptible_for(context, faces.size(), [&](Index f) {
    std::array<Corner, 3> corner;
    int positive = 0;
    for (int k = 0; k < 3; ++k) {
      const Index i = faces[f][k];
      corner[k] = {points[i] - origin, feet.row(i).transpose() - origin, distances[i]};
      positive += distances[i] > 0;
    }
    if (positive == 3)
      add_triangle(corner[0], corner[1], corner[2], sides.positive_area, sides.positive_volume);
    else if (positive == 0)
      add_triangle(corner[0], corner[1], corner[2], sides.negative_area, sides.negative_volume);
    else
      for (int k = 0; k < 3; ++k)
        if ((corner[k].distance > 0) == (positive == 1))
          add_cut(corner[k], corner[(k + 1) % 3], corner[(k + 2) % 3], sides);
  });
  return sides;
}

// Standard deviations that a part along the surface is to exceed.
constexpr double detected = 2;

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

void run_asymmetry(const Matchers& matchers, const OperationInput& input, const Mirror& mirror,
                   const ParameterValues& values, const Context& context, OperationResult& result) {
  const PointsView points = input.own();
  const Index count = points.size();
  const double diagonal = diagonal_of(points);
  const Counterparts counterparts(input, mirror, limits_of(values, points), context.stage(0, 0.8),
                                  pairing_of(values, matchers));
  Points vector(count, 3), weights(count, 3);
  Eigen::VectorXd distance(count), outward(count), tangential(count), lateral(count),
      matched(count), face(count), confidence(count);
  interruptible_for(context, count, [&](Index i) {
    const Counterpart& counterpart = counterparts[i];
    const Vector3 x = points[i];
    const Vector3 to_place = (counterpart.matched ? counterpart.place : Counterpart::nowhere) - x;
    const Vector3 from_mirror = x - counterparts.image(i);  // twice as far
    vector.row(i) = to_place.transpose();
    distance[i] = to_place.norm();
    const Vector3 normal = counterparts.normals().row(i).transpose();
    outward[i] = to_place.dot(normal);
    tangential[i] = (to_place - outward[i] * normal).norm();
    lateral[i] = input.own_points > 0 ? NAN : to_place.dot(from_mirror.stableNormalized());
    matched[i] = counterpart.matched ? 1 : 0;
    face[i] = counterpart.matched ? static_cast<double>(counterpart.face) : -1;
    weights.row(i) = counterpart.weights.transpose();
    confidence[i] = counterparts.confidence(i, input.points);
  });
  Values& statistics = result.statistics;
  statistics["matched_share"] =
      static_cast<double>(counterparts.matched()) / static_cast<double>(count);
  counterparts.report(statistics);
  statistics["diagonal"] = diagonal;
  Eigen::VectorXd of_surface = distance;  // not of vertices that no face uses
  if (!input.faces.empty()) {
    of_surface.setConstant(std::numeric_limits<double>::quiet_NaN());
    for (Index f = 0; f < input.faces.size(); ++f)
      for (int k = 0; k < 3; ++k)
        if (const Index i = input.faces[f][k]; i < count) of_surface[i] = distance[i];
  }
  report_distances(statistics, of_surface, outward, diagonal, context);
  if (!input.faces.empty())
    report_sides(statistics, input, mirror, counterparts.is_watertight(), context.stage(0.8, 1));
  result.arrays = {{"vector", vector},         {"distance", distance}, {"signed", outward},
                   {"tangential", tangential}, {"lateral", lateral},   {"matched", matched},
                   {"confidence", confidence}};
  if (const HomologousPoints* homologous = counterparts.homologous()) {
    const auto is_known = distance.array().isFinite();  // others have no vector
    const Eigen::VectorXd deviations = homologous->deviations.head(count);
    result.arrays["vector_sd"] = is_known.select(deviations, distance);
    result.arrays["known"] = is_known.select(homologous->known.head(count), distance);
    report_length(statistics, "detectable_tangential",
                  detected * median(std::vector(deviations.begin(), deviations.end())), diagonal);
  }
  if (!input.faces.empty()) {
    result.arrays["face"] = face;
    result.arrays["weights"] = weights;
  }
}

}  // namespace

OperationImplementation asymmetry_operation(const Matchers& matchers) {
  OperationImplementation operation;
  operation.name = "asymmetry";
  operation.title = "Mirror asymmetry";
  operation.summary =
      "Measures the distance of each point from its counterpart: the closest or the homologous "
      "point of the mirrored surface.";
  operation.parameters = {pairing(), max_distance(), max_angle()};
  operation.arrays = {
      {"vector", ParameterType::Real, 3,
       "Vector from the point to its counterpart, input units; NaN without one."},
      {"distance", ParameterType::Real, 1, "Length of the vector, input units."},
      {"signed", ParameterType::Real, 1,
       "Component of the vector along the outward normal, input units: positive if the point lies "
       "too far in.",
       true},
      {"tangential", ParameterType::Real, 1,
       "Component of the vector along the surface, input units."},
      {"lateral", ParameterType::Real, 1,
       "Component of the vector away from the mirror, input units; NaN of two shapes.", true},
      {"matched", ParameterType::Boolean, 1,
       "Whether the point has a counterpart: none beyond a boundary of the surface, too far away, "
       "or with a different normal."},
      {"confidence", ParameterType::Real, 1,
       "0 to 1: the cosine between the normals, halved if the closest image is one point spacing "
       "away; with homologous pairing the array known."},
      {"vector_sd", ParameterType::Real, 1,
       "With homologous pairing: the standard deviation of the vector along the surface, input "
       "units; 0 where both sides have one triangulation."},
      {"known", ParameterType::Real, 1,
       "With homologous pairing: the share of the variance along the surface that the shape "
       "explains, 0 to 1."},
      {"face", ParameterType::Integer, 1,
       "For a mesh: the face on whose image the counterpart lies; -1 for none.", false, false,
       true},
      {"weights", ParameterType::Real, 3,
       "For a mesh: barycentric coordinates of the counterpart on that face."},
  };
  operation.shown = "signed";
  operation.takes_other = true;
  operation.run = std::bind_front(run_asymmetry, matchers);
  return operation;
}

}  // namespace symsurf
