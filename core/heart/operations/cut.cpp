#include "operations/cap.h"
#include "operations/half.h"
#include "operations/operation_registry.h"

namespace symsurf {

namespace {

// Points and faces of the cap, with what the points and faces beside them have.
void add_cap(const Cap& cap, Half& half) {
  const Index points = half.points.rows(), faces = half.faces.rows();
  std::vector<Index> face_at(points, 0);
  for (Index f = 0; f < faces; ++f)
    for (const Index i : half.faces.row(f)) face_at[i] = f;
  std::vector<Index> source(points + cap.points.rows(), -1);
  for (Index i = 0; i < points; ++i) source[i] = i;
  // From the rim inwards.
  for (bool any = true; any;) {
    any = false;
    for (const auto& face : cap.faces.rowwise())
      for (int k = 0; k < 3; ++k)
        if (const Index from = source[face[(k + 1) % 3]]; source[face[k]] < 0 && from >= 0) {
          source[face[k]] = from;
          any = true;
        }
  }
  half.points.conservativeResize(points + cap.points.rows(), 3);
  half.points.bottomRows(cap.points.rows()) = cap.points;
  half.parents.conservativeResize(half.points.rows(), 3);
  half.shares.conservativeResize(half.points.rows(), 3);
  for (Index i = points; i < half.points.rows(); ++i) {
    half.parents.row(i) = half.parents.row(source[i]);
    half.shares.row(i) = half.shares.row(source[i]);
    half.on_mirror.push_back(true);
  }
  half.faces.conservativeResize(faces + cap.faces.rows(), 3);
  half.faces.bottomRows(cap.faces.rows()) = cap.faces;
  for (const auto& face : cap.faces.rowwise())
    half.face_sources.push_back(half.face_sources[face_at[source[face[0]]]]);
}

void run_cut(const OperationInput& input, const Mirror& mirror, const ParameterValues& values,
             const Context& context, OperationResult& result) {
  Half half =
      half_of(input.points, input.faces, mirror, keeps_positive(values), context.stage(0, 0.4));
  const Index faces = half.faces.rows();
  if (values.boolean("capped") && faces > 0) {
    const Cap cap = cap_of(half, mirror, context.stage(0.4, 1));
    add_cap(cap, half);
    result.statistics["open_curves"] = cap.open;
  }
  Eigen::VectorXd on_mirror(half.points.rows());
  for (Index i = 0; i < on_mirror.size(); ++i) on_mirror[i] = half.on_mirror[i];
  Eigen::VectorXd is_cap = Eigen::VectorXd::Zero(half.faces.rows());
  is_cap.tail(half.faces.rows() - faces).setOnes();
  result.statistics["cap_faces"] = half.faces.rows() - faces;
  result.arrays = {{"on_mirror", on_mirror}};
  result.face_arrays = {{"cap", is_cap}};
  set_shape(std::move(half), result);
}

}  // namespace

OperationImplementation cut_operation() {
  OperationImplementation operation;
  operation.name = "cut";
  operation.title = "Mirror cut";
  operation.summary = "Cuts the shape along the mirror and keeps one side: half a model.";
  operation.parameters = {
      kept_side(),
      Parameter::boolean("capped", true,
                         "Close a mesh by faces within the mirror; what is closed stays so.")};
  operation.arrays = {{"on_mirror", ParameterType::Boolean, 1,
                       "Whether the point lies on the mirror: at the cut or within it."}};
  operation.face_arrays = {
      {"cap", ParameterType::Boolean, 1, "Whether the face lies within the mirror and closes it."}};
  operation.moves_points = true;
  operation.makes_shape = true;
  operation.run = run_cut;
  return operation;
}

}  // namespace symsurf
