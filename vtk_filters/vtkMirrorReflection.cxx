#include "vtkMirrorReflection.h"

#include <symsurf/make_mirror.h>

#include <vector>

#include "core_call.h"
#include "field_values.h"
#include "point_arrays.h"
#include "point_subset.h"
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

std::shared_ptr<symsurf::Mirror> mirror_of(vtkPolyData* data) {
  const symsurf::Values numbers = field_values(data->GetFieldData());
  const auto kind = numbers.find("kind");
  if (kind == numbers.end())
    throw symsurf::InvalidInput(
        "the mirror has no field data array Kind; connect the output \"Mirror\" of a mirror "
        "detection");
  return symsurf::make_mirror(symsurf::to_string(kind->second), numbers);
}

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
  vtkPolyData* input = vtkPolyData::GetData(inputs[0]);
  vtkPolyData* mirror = vtkPolyData::GetData(inputs[1]);
  return core_call(this, [&] {
    const symsurf::Points images = mirror_of(mirror)->reflect(points_of(input).view());
    const std::vector<symsurf::Index> kept = rows_without_nan(images);
    vtkNew<vtkPolyData> reflected;
    set_subset(reflected, input, images(kept, Eigen::indexing::all), kept);
    reflected->GetPointData()->SetNormals(nullptr);
    reflected->GetCellData()->SetNormals(nullptr);

    vtkNew<vtkReverseSense> reverse;
    reverse->SetInputData(reflected);
    reverse->ReverseCellsOn();
    reverse->Update();
    vtkPolyData::GetData(outputs)->ShallowCopy(reverse->GetOutput());
  });
}
