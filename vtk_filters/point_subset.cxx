#include "point_subset.h"

#include "carried_arrays.h"
#include "point_arrays.h"
#include "vtkCellData.h"
#include "vtkIdList.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"

namespace {

void copy_whole_cells(vtkPolyData* output, vtkPolyData* input,
                      const std::vector<symsurf::Index>& kept) {
  std::vector<vtkIdType> renumbered(input->GetNumberOfPoints(), -1);
  for (std::size_t row = 0; row < kept.size(); ++row)
    renumbered[kept[row]] = static_cast<vtkIdType>(row);
  const vtkIdType cells = input->GetNumberOfCells();
  output->AllocateEstimate(cells, 4);
  output->GetCellData()->CopyAllOn();
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
}

}  // namespace

void set_subset(vtkPolyData* output, vtkPolyData* input, const symsurf::Points& points,
                const std::vector<symsurf::Index>& kept) {
  if (static_cast<vtkIdType>(kept.size()) == input->GetNumberOfPoints()) {
    output->ShallowCopy(input);
    set_points(output, points);
    return;
  }
  set_points(output, points);
  output->GetFieldData()->ShallowCopy(input->GetFieldData());
  copy_rows(output->GetPointData(), input->GetPointData(), kept);
  copy_whole_cells(output, input, kept);
}
