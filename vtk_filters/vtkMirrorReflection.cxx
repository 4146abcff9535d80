#include "vtkMirrorReflection.h"

#include <symsurf/make_mirror.h>

#include <vector>

#include "core_call.h"
#include "field_values.h"
#include "point_arrays.h"
#include "vtkCellData.h"
#include "vtkIdList.h"
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

// The rows without NaN, and the cells that use no other rows.
vtkNew<vtkPolyData> with_images_only(vtkPolyData* input, const symsurf::Points& images) {
  std::vector<vtkIdType> renumbered(images.rows(), -1);
  vtkNew<vtkIdList> kept;
  for (symsurf::Index i = 0; i < images.rows(); ++i)
    if (images.row(i).allFinite()) renumbered[i] = kept->InsertNextId(i);

  vtkNew<vtkPolyData> output;
  symsurf::Points points(kept->GetNumberOfIds(), 3);
  for (symsurf::Index row = 0; row < points.rows(); ++row)
    points.row(row) = images.row(kept->GetId(row));
  set_points(output, points);
  output->GetFieldData()->ShallowCopy(input->GetFieldData());
  output->GetPointData()->CopyAllocate(input->GetPointData(), points.rows());
  output->GetPointData()->CopyData(input->GetPointData(), kept);

  const vtkIdType cells = input->GetNumberOfCells();
  output->AllocateEstimate(cells, 4);
  output->GetCellData()->CopyAllocate(input->GetCellData(), cells);
  vtkNew<vtkIdList> corners;
  for (vtkIdType cell = 0; cell < cells; ++cell) {
    input->GetCellPoints(cell, corners);
    bool whole = true;
    for (vtkIdType i = 0; i < corners->GetNumberOfIds(); ++i) {
      corners->SetId(i, renumbered[corners->GetId(i)]);
      whole = whole && corners->GetId(i) >= 0;
    }
    if (!whole) continue;
    const vtkIdType copy = output->InsertNextCell(input->GetCellType(cell), corners);
    output->GetCellData()->CopyData(input->GetCellData(), cell, copy);
  }
  return output;
}

}  // namespace

vtkMirrorReflection::vtkMirrorReflection() { this->SetNumberOfInputPorts(2); }

int vtkMirrorReflection::RequestData(vtkInformation*, vtkInformationVector** inputs,
                                     vtkInformationVector* outputs) {
  vtkPolyData* input = vtkPolyData::GetData(inputs[0]);
  vtkPolyData* mirror = vtkPolyData::GetData(inputs[1]);
  return core_call(this, [&] {
    const symsurf::Points images = mirror_of(mirror)->reflect(points_of(input).view());
    vtkNew<vtkPolyData> reflected;
    if (images.allFinite()) {
      reflected->ShallowCopy(input);
      set_points(reflected, images);
    } else {
      reflected->ShallowCopy(with_images_only(input, images));
    }
    reflected->GetPointData()->SetNormals(nullptr);
    reflected->GetCellData()->SetNormals(nullptr);

    vtkNew<vtkReverseSense> reverse;
    reverse->SetInputData(reflected);
    reverse->ReverseCellsOn();
    reverse->Update();
    vtkPolyData::GetData(outputs)->ShallowCopy(reverse->GetOutput());
  });
}
