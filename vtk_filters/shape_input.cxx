#include "shape_input.h"

#include <symsurf/context.h>

#include <string>
#include <vector>

#include "controller_communicator.h"
#include "mirror_input.h"
#include "point_arrays.h"
#include "vtkAppendPolyData.h"
#include "vtkCellArray.h"
#include "vtkCompositeDataIterator.h"
#include "vtkCompositeDataSet.h"
#include "vtkGeometryFilter.h"
#include "vtkInformation.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkShapeAlgorithm.h"
#include "vtkUnstructuredGrid.h"

namespace {

using Shape = vtkSmartPointer<vtkPolyData>;

Shape surface_of(vtkPointSet* data) {
  if (data->GetNumberOfCells() == 0) {
    auto points = Shape::New();
    points->SetPoints(data->GetPoints());
    points->GetPointData()->ShallowCopy(data->GetPointData());
    points->GetFieldData()->ShallowCopy(data->GetFieldData());
    return points;
  }
  if (auto* grid = vtkUnstructuredGrid::SafeDownCast(data))
    require_points(grid->GetCells(), grid->GetNumberOfPoints());
  vtkNew<vtkGeometryFilter> surface;
  surface->SetInputData(data);
  surface->Update();
  return surface->GetOutput();
}

Shape points_above(vtkShapeAlgorithm* filter, vtkDataSet* image) {
  if (image->GetNumberOfPoints() == 0) return Shape::New();
  const char* name = filter->GetInputArrayInformation(0)->Get(vtkDataObject::FIELD_NAME());
  vtkPointData* data = image->GetPointData();
  vtkDataArray* scalars = name && *name ? data->GetArray(name) : data->GetScalars();
  if (!scalars)
    throw symsurf::InvalidInput(
        "the " + std::string(image->GetClassName()) + " has no point scalars " +
        (name && *name ? name : "that are active") + ", which say what of it is the shape");
  if (scalars->GetNumberOfComponents() != 1)
    throw symsurf::InvalidInput("the scalars of the " + std::string(image->GetClassName()) +
                                " have " + std::to_string(scalars->GetNumberOfComponents()) +
                                " components; allowed is one");
  std::vector<vtkIdType> kept;
  for (vtkIdType i = 0; i < image->GetNumberOfPoints(); ++i)
    if (scalars->GetComponent(i, 0) > filter->GetImageThreshold()) kept.push_back(i);

  const auto count = static_cast<vtkIdType>(kept.size());
  symsurf::Points points(count, 3);
  for (vtkIdType row = 0; row < count; ++row) image->GetPoint(kept[row], points.row(row).data());
  auto above = Shape::New();
  set_vertices(above, points);
  above->GetFieldData()->ShallowCopy(image->GetFieldData());
  above->GetPointData()->CopyAllocate(data, count);
  for (vtkIdType row = 0; row < count; ++row) above->GetPointData()->CopyData(data, kept[row], row);
  return above;
}

Shape shape_of(vtkShapeAlgorithm* filter, vtkDataObject* data);

Shape joined_blocks(vtkShapeAlgorithm* filter, vtkCompositeDataSet* composite) {
  vtkNew<vtkAppendPolyData> joined;
  const auto block = vtkSmartPointer<vtkCompositeDataIterator>::Take(composite->NewIterator());
  for (block->InitTraversal(); !block->IsDoneWithTraversal(); block->GoToNextItem())
    joined->AddInputData(shape_of(filter, block->GetCurrentDataObject()));
  if (joined->GetNumberOfInputConnections(0) == 0) return Shape::New();
  joined->Update();
  return joined->GetOutput();
}

Shape shape_of(vtkShapeAlgorithm* filter, vtkDataObject* data) {
  if (!data) return nullptr;
  if (is_mirror(data))
    throw symsurf::InvalidInput(
        "the input is a mirror, by its field data array Kind; connect a shape: output 0 "
        "\"Shape\" of a mirror detection, or what that takes");
  if (auto* polygons = vtkPolyData::SafeDownCast(data)) {
    for (vtkCellArray* cells :
         {polygons->GetVerts(), polygons->GetLines(), polygons->GetPolys(), polygons->GetStrips()})
      require_points(cells, polygons->GetNumberOfPoints());
    return polygons;
  }
  if (auto* points = vtkPointSet::SafeDownCast(data)) return surface_of(points);
  if (data->IsA("vtkImageData") || data->IsA("vtkRectilinearGrid"))
    return points_above(filter, vtkDataSet::SafeDownCast(data));
  if (auto* composite = vtkCompositeDataSet::SafeDownCast(data))
    return joined_blocks(filter, composite);
  throw symsurf::InvalidInput("the input is a " + std::string(data->GetClassName()) +
                              "; allowed are vtkPolyData and other point sets, images and "
                              "composites of these");
}

}  // namespace

vtkSmartPointer<vtkPolyData> shape_of(vtkShapeAlgorithm* filter, vtkInformationVector** inputs) {
  return shape_of(filter, vtkDataObject::GetData(inputs[0]));
}

vtkSmartPointer<vtkPolyData> shape_of(vtkShapeAlgorithm* filter, vtkInformationVector** inputs,
                                      const ControllerCommunicator& processes) {
  Shape shape;
  together(processes, [&] { shape = shape_of(filter, inputs); });
  return shape;
}
