#include "operations/counterparts.h"
#include "operations/operation.h"

namespace symsurf {

namespace {

void run_correspondences(const Matchers& matchers, const OperationInput& input,
                         const Mirror& mirror, const ParameterValues& values,
                         const Context& context, OperationResult& result) {
  const PointsView points = input.points;
  const Index count = points.size();
  const Counterparts counterparts(input, mirror, limits_of(values, input.own()), context,
                                  pairing_of(values, matchers));
  Eigen::VectorXd index(count), confidence(count), face(count);
  Points weights(count, 3);
  for (Index i = 0; i < count; ++i) {
    const Counterpart& c = counterparts[i];
    index[i] = c.matched ? static_cast<double>(c.nearest) : -1;
    face[i] = c.matched ? static_cast<double>(c.face) : -1;
    weights.row(i) = c.weights.transpose();
    confidence[i] = counterparts.confidence(i, points);
  }
  if (values.boolean("one_to_one")) {
    const Eigen::VectorXd all = index;
    for (Index i = 0; i < count; ++i)
      if (all[i] >= 0 && all[static_cast<Index>(all[i])] != static_cast<double>(i)) {
        index[i] = face[i] = -1;
        confidence[i] = 0;
      }
  }
  const Index own = input.own().size();
  const auto paired = static_cast<double>((index.head(own).array() >= 0).count());
  result.statistics["paired_share"] = paired / static_cast<double>(own);
  counterparts.report(result.statistics);
  result.arrays = {{"index", index}, {"confidence", confidence}};
  if (!input.faces.empty()) {
    result.arrays["face"] = face;
    result.arrays["weights"] = weights;
  }
}

}  // namespace

OperationImplementation correspondences_operation(const Matchers& matchers) {
  OperationImplementation operation;
  operation.name = "correspondences";
  operation.title = "Mirror correspondences";
  operation.summary = "Finds for each point the input point that mirrors it.";
  operation.parameters = {
      pairing(),
      Parameter::boolean("one_to_one", false,
                         "Keep only pairs of points that are each other's mirror points."),
      max_distance(), max_angle()};
  operation.arrays = {
      {"index", ParameterType::Integer, 1,
       "Index of the mirror point, of the point itself if it lies on the mirror, -1 for none. For "
       "a mesh: of the face closest to the image, the corner closest to it.",
       false, true},
      {"confidence", ParameterType::Real, 1,
       "0 to 1: the cosine between the normals, halved if the closest image is one point spacing "
       "away; with homologous pairing the share of the variance along the surface that the shape "
       "explains; with topology 1 or 0."},
      {"face", ParameterType::Integer, 1, "For a mesh: the face closest to the image; -1 for none.",
       false, false, true},
      {"weights", ParameterType::Real, 3,
       "For a mesh: barycentric coordinates of the counterpart on that face."},
  };
  operation.shown = "confidence";
  operation.takes_other = true;
  operation.run = std::bind_front(run_correspondences, matchers);
  return operation;
}

namespace {

// The share of its own values that a point keeps.
double own_share(const std::string& side, double signed_distance, double near) {
  if (side == "average") return 0.5;
  const double inside = side == "positive" ? signed_distance : -signed_distance;
  return inside >= -near ? 1 : 0;
}

void run_transfer(const Matchers& matchers, const OperationInput& input, const Mirror& mirror,
                  const ParameterValues& values, const Context& context, OperationResult& result) {
  const PointsView points = input.points;
  const Index count = points.size();
  const Counterparts counterparts(input, mirror, limits_of(values, points), context,
                                  pairing_of(values, matchers));
  const std::string& side = values.choice("side");
  const double near = mirror_tolerance * diagonal_of(points);
  result.point_parents.resize(count, 4);
  result.point_shares.setZero(count, 4);
  Eigen::VectorXd failed = Eigen::VectorXd::Zero(count);
  for (Index i = 0; i < count; ++i) {
    const Counterpart& c = counterparts[i];
    double own = own_share(side, counterparts.signed_distance(i), near);
    failed[i] = own < 1 && !c.matched;
    if (!c.matched) own = 1;
    result.point_parents.row(i).setConstant(i);
    result.point_shares(i, 0) = own;
    result.point_sources.push_back(own < 0.5 ? c.nearest : i);
    if (own == 1) continue;
    // A vertex gives its own values, also where it has copies with others.
    if (c.face < 0 || c.weights.maxCoeff() == 1) {
      result.point_parents(i, 1) = c.nearest;
      result.point_shares(i, 1) = 1 - own;
      continue;
    }
    for (int k = 0; k < 3; ++k) {
      result.point_parents(i, k + 1) = input.faces[c.face][k];
      result.point_shares(i, k + 1) = (1 - own) * c.weights[k];
    }
  }
  result.statistics["failed_points"] = static_cast<Index>(failed.sum());
  counterparts.report(result.statistics);
  result.arrays = {{"failed", failed}};
}

}  // namespace

OperationImplementation transfer_operation(const Matchers& matchers) {
  OperationImplementation operation;
  operation.name = "transfer";
  operation.title = "Mirror transfer";
  operation.summary =
      "Copies attributes of the points, such as labels, weights and colours, from one side to the "
      "other, or averages them.";
  operation.parameters = {
      Parameter::choice(
          "side", "positive", {"positive", "negative", "average"},
          "Side whose values both sides get: where the signed distance from the mirror is positive "
          "or negative, or their average, which leaves integers unchanged."),
      pairing(), max_distance(), max_angle()};
  operation.arrays = {
      {"failed", ParameterType::Boolean, 1,
       "Whether the point has no counterpart to take values from, and keeps its own."}};
  operation.shown = "";
  operation.carries_values = true;
  operation.run = std::bind_front(run_transfer, matchers);
  return operation;
}

}  // namespace symsurf
