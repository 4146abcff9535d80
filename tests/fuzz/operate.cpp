#include <symsurf/attributes.h>

#include <algorithm>

#include "draw.h"
#include "impatient.h"
#include "result.h"

namespace symsurf {
namespace {

Eigen::VectorXd mask(Source& source, Index points) {
  Eigen::VectorXd values(one_in(source, 8) ? points + 1 : points);
  for (double& each : values) each = source.ConsumeIntegralInRange(0, 4) / 4.0;
  if (values.size() > 0 && one_in(source, 8)) values[0] = extreme(source);
  return values;
}

void expect_sources(const std::vector<Index>& sources, Index rows, Index of) {
  if (sources.empty()) return;
  expect(static_cast<Index>(sources.size()) == rows, "each row has a source, or none has");
  for (const Index source : sources)
    expect(source >= 0 && source < of, "sources are rows of the input");
}

// What a description promises of every result.
void expect_as_described(const OperationResult& result, const Operation& operation,
                         const Points& points, const Triangles& faces) {
  const Index rows = result.points.rows();
  if (result.point_parents.rows() > 0) {
    expect(
        (operation.makes_shape || operation.carries_values) && result.point_parents.rows() == rows,
        "parents of each point");
    expect((result.point_parents.array() >= 0).all() &&
               (result.point_parents.array() < points.rows()).all(),
           "parents are rows of the input");
    expect((result.point_shares.rowwise().sum().array() - 1).abs().maxCoeff() < 1e-12,
           "shares sum to 1");
  }
  if (!result.is_other_shape()) {
    expect(operation.adds_points ? rows >= points.rows() : rows == points.rows(), "a row a point");
    expect(operation.adds_points ? result.faces.rows() >= faces.rows()
                                 : result.faces.rows() == faces.rows(),
           "faces stay");
  }
  for (Index i = 0; i < rows; ++i) {
    const bool is_given = !result.is_other_shape() && i < points.rows();
    if (is_given && !points.row(i).allFinite())
      expect(!result.points.row(i).allFinite(), "what is not finite stays so");
    else
      expect(result.points.row(i).allFinite() &&
                 (!is_given || operation.moves_points || result.points.row(i) == points.row(i)),
             "points are finite, and stay where they are");
  }
  for (const Index corner : result.faces.reshaped())
    expect(corner >= 0 && corner < rows, "a face's corner is a point");
  expect_sources(result.point_sources, rows, points.rows());
  expect_sources(result.face_sources, result.faces.rows(), faces.rows());
  for (const PointArray& each : operation.face_arrays)
    expect(result.face_arrays.at(each.name).rows() == result.faces.rows(), "a row a face");
  // Some are of meshes only.
  for (const auto& [name, array] : result.arrays) {
    const auto described = std::find_if(operation.arrays.begin(), operation.arrays.end(),
                                        [&](const PointArray& each) { return each.name == name; });
    expect(described != operation.arrays.end(), "arrays are described");
    expect(array.rows() == rows && array.cols() == described->components,
           "arrays have a row a point");
  }
}

void fuzz(Source& source) {
  const Operation& operation = one_of(operations(), source);
  const Points points = cloud(source, most_for_searches);
  const Triangles triangles = one_in(source, 2) ? faces(source, points.rows()) : Triangles(0, 3);
  OperationInput input{points, triangles};
  if (one_in(source, operation.takes_mask ? 2 : 16)) input.mask = mask(source, points.rows());
  const Values given = parameters(source, operation.parameters);
  show("operation", '"' + operation.name + '"');
  show("parameters", given);
  show_rows("points", points);
  show_rows("faces", triangles);
  show_rows("mask", input.mask);
  const std::shared_ptr<Mirror> mirror = drawn_mirror(source);
  const OperationResult result = operate(operation.name, input, *mirror, given, impatient(source));
  expect_as_described(result, operation, points, triangles);
  const AttributeTransform by(result, points, mirror.get());
  for (const auto kind : {AttributeKind::Vector, AttributeKind::Normal})
    expect(by(points, kind).rows() == result.points.rows(), "directions of each point");
}

}  // namespace
}  // namespace symsurf

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  symsurf::Source source(data, size);
  symsurf::runs([&] { symsurf::fuzz(source); });
  return 0;
}
