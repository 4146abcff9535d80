#include "operations/counterparts.h"
#include "operations/operation_registry.h"

namespace symsurf {

namespace {

void run_correspondences(const OperationInput& input, const Mirror& mirror,
                         const ParameterValues& values, const Context& context,
                         OperationResult& result) {
  const PointsView points = input.points;
  const Index count = points.size();
  const Counterparts counterparts(input, mirror, limits_of(values, points), context,
                                  pairing_of(values));
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
  const auto paired = static_cast<double>((index.array() >= 0).count());
  result.statistics["paired_share"] = paired / static_cast<double>(count);
  counterparts.report_unmatched(result.statistics);
  result.arrays = {{"index", index}, {"confidence", confidence}};
  if (!input.faces.empty()) {
    result.arrays["face"] = face;
    result.arrays["weights"] = weights;
  }
}

}  // namespace

OperationImplementation correspondences_operation() {
  OperationImplementation operation;
  operation.name = "correspondences";
  operation.title = "Mirror correspondences";
  operation.summary = "Gives for each point the point of the input that mirrors it.";
  operation.parameters = {
      pairing(),
      Parameter::boolean("one_to_one", false,
                         "Only pairs of points that are each other's mirror points."),
      max_distance(), max_angle()};
  operation.arrays = {
      {"index", ParameterType::Integer, 1,
       "The mirror point, the point itself on the mirror, -1 for none. Of a mesh the closest "
       "corner of the face that the image comes closest to.",
       false, true},
      {"confidence", ParameterType::Real, 1,
       "0 to 1: the cosine between the normals, halved where the closest image, or the way to the "
       "homologous point and back, ends a spacing away."},
      {"face", ParameterType::Integer, 1,
       "Of a mesh, the face that the image comes closest to; -1 for none.", false, false, true},
      {"weights", ParameterType::Real, 3, "Of a mesh, the barycentric coordinates on that face."},
  };
  operation.shown = "confidence";
  operation.run = run_correspondences;
  return operation;
}

}  // namespace symsurf
