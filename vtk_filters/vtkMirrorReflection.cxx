#include "vtkMirrorReflection.h"

#include <vector>

#include "carried_arrays.h"
#include "core_call.h"
#include "mirror_input.h"
#include "point_arrays.h"
#include "point_subset.h"
#include "shape_input.h"
#include "vtkCellData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkReverseSense.h"

vtkStandardNewMacro(vtkMirrorReflection);

namespace {

std::vector<symsurf::Index> rows_without_nan(const symsurf::Points& points) {
  std::vector<symsurf::Index> rows;
  for (symsurf::Index i = 0; i < points.rows(); ++i)
    if (points.row(i).allFinite()) rows.push_back(i);
  return rows;
}

}  // namespace

vtkMirrorReflection::vtkMirrorReflection() { this->SetNumberOfInputPorts(2); }

int vtkMirrorReflection::RequestData(vtkInformation*, vtkInformationVector** inputs,
                                     vtkInformationVector* outputs) {
  vtkPolyData* mirror = vtkPolyData::GetData(inputs[1]);
  return core_call(this, [&] {
    const auto input = shape_of(this, inputs);
    const auto over = mirror_of(mirror);
    const PointArray points = points_of(input);
    const symsurf::Points images = over->reflect(points.view(), context_of(this));
    const std::vector<symsurf::Index> kept = rows_without_nan(images);
    vtkNew<vtkPolyData> reflected;
    set_subset(reflected, input, images(kept, Eigen::indexing::all), kept);
    reflected->GetCellData()->SetNormals(nullptr);
    vtkNew<vtkPointData> given;
    given->ShallowCopy(reflected->GetPointData());
    const symsurf::Points own = points.view().matrix()(kept, Eigen::indexing::all);
    carry_values(reflected->GetPointData(), given, {*over, own}, false);

    vtkNew<vtkReverseSense> reverse;
    reverse->SetInputData(reflected);
    reverse->ReverseCellsOn();
    reverse->Update();
    vtkPolyData::GetData(outputs)->ShallowCopy(reverse->GetOutput());
  });
}
