#include "run_operation.h"

#include <symsurf/attributes.h>
#include <symsurf/detect.h>
#include <symsurf/operations.h>

#include "controller_communicator.h"
#include "core_call.h"
#include "mirror_input.h"
#include "operation_output.h"
#include "point_arrays.h"
#include "shape_input.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkMirrorOperation.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"

namespace {

std::string names_of_arrays(vtkPointData* data) {
  std::string names;
  for (int i = 0; i < data->GetNumberOfArrays(); ++i)
    if (data->GetArrayName(i))
      names += (names.empty() ? "" : ", ") + std::string(data->GetArrayName(i));
  return names.empty() ? "none" : names;
}

Eigen::VectorXd mask_of(vtkPolyData* input, const std::string& name) {
  vtkPointData* data = input->GetPointData();
  vtkDataArray* array = data->GetArray(name.c_str());
  if (name.empty() || (name == "None" && !array)) return {};
  if (!array)
    throw symsurf::InvalidParameter(
        "MaskArray is '" + name +
        "'; allowed are the input's point arrays: " + names_of_arrays(data));
  if (array->GetNumberOfComponents() != 1)
    throw symsurf::InvalidParameter("MaskArray is '" + name + "', which has " +
                                    std::to_string(array->GetNumberOfComponents()) +
                                    " components; allowed is one");
  Eigen::VectorXd mask(array->GetNumberOfTuples());
  for (Eigen::Index i = 0; i < mask.size(); ++i) mask[i] = array->GetComponent(i, 0);
  return mask;
}

// Of landmarks that follow each other by twos.
Eigen::MatrixXd landmark_pairs_of(vtkPolyData* data) {
  const PointArray array = points_of(data);
  const symsurf::PointsView points = array.view();
  if (points.size() % 2 != 0)
    throw symsurf::InvalidInput("the landmarks are " + std::to_string(points.size()) +
                                " points; allowed are two for each pair");
  Eigen::MatrixXd pairs = Eigen::MatrixXd::Zero(points.size() / 2, 7);
  vtkDataArray* deviations = data ? data->GetPointData()->GetArray("Deviation") : nullptr;
  for (Eigen::Index k = 0; k < pairs.rows(); ++k) {
    pairs.row(k).head(6) << points[2 * k].transpose(), points[2 * k + 1].transpose();
    if (deviations) pairs(k, 6) = deviations->GetComponent(2 * k, 0);
  }
  return pairs;
}

std::shared_ptr<symsurf::Mirror> found_first(vtkMirrorOperation* filter,
                                             const symsurf::OperationInput& input,
                                             const symsurf::Context& context) {
  symsurf::Options options;
  options.method = filter->GetMethod();
  options.faces = input.faces;
  const symsurf::FoundMirror found = symsurf::found_mirror(
      symsurf::detect(input.points, options, context), filter->GetRequireFound());
  if (!found.warning.empty()) vtkWarningWithObjectMacro(filter, << found.warning);
  return found.mirror;
}

}  // namespace

int run_operation(vtkMirrorOperation* filter, vtkInformationVector** inputs,
                  vtkInformationVector* outputs, const OperationCall& call) {
  vtkPolyData* given = vtkPolyData::GetData(inputs[1]);
  return core_call(filter, [&] {
    const ControllerCommunicator processes(filter->GetController());
    const auto shape = shape_of(filter, inputs, processes);
    const PointArray points = points_of(shape);
    if (are_elsewhere(processes, points.view().size(), "an operation")) return;
    const TriangleArray faces(shape);
    vtkPolyData* const second = vtkPolyData::GetData(inputs[2]);
    const PointArray other = points_of(second);
    const TriangleArray other_faces(second);
    symsurf::OperationInput input{points.view(), faces.view(), mask_of(shape, call.mask_array)};
    input.other = other.view();
    input.other_faces = other_faces.view();
    input.landmark_pairs = landmark_pairs_of(vtkPolyData::GetData(inputs[3]));
    const KindsByName kinds = kinds_of(filter->GetKinds(), shape->GetPointData());
    const symsurf::Context context = context_of(filter, filter->GetNumberOfThreads());
    if (second && given)
      throw symsurf::InvalidInput(
          "a mirror and a second shape are connected; allowed is one of them");
    const bool is_needed = !second && symsurf::needs_mirror(call.operation, call.parameters);
    const double found_at = given || !is_needed ? 0 : 0.6;
    std::shared_ptr<symsurf::Mirror> mirror;
    if (is_needed)
      mirror = given ? mirror_of(given) : found_first(filter, input, context.stage(0, found_at));
    const symsurf::OperationResult result = symsurf::operate(
        call.operation, input, mirror.get(), call.parameters, context.stage(found_at, 1));
    warn_of(filter, result.statistics);
    vtkPolyData* whole = vtkPolyData::GetData(outputs, 0);
    const symsurf::AttributeTransform by(result, points.view(), mirror.get(), context.stage(1, 1));
    const vtkNew<vtkPolyData> added = set_operated(whole, shape, faces, result, by, kinds);
    if (filter->GetNumberOfOutputPorts() > 1)
      set_patch(vtkPolyData::GetData(outputs, 1), added, points.view().size());
  });
}
