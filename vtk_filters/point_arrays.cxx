#include "point_arrays.h"

#include <symsurf/context.h>
#include <symsurf/mirror.h>

#include <algorithm>
#include <numeric>
#include <string>

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkNew.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkTriangleFilter.h"

namespace {

// Cells of `corners` points each, from their points' indices.
template <typename Fill>
vtkNew<vtkCellArray> cells_of(vtkIdType count, int corners, const Fill& fill) {
  vtkNew<vtkTypeInt64Array> offsets, connectivity;
  offsets->SetNumberOfValues(count + 1);
  vtkTypeInt64* offset = offsets->GetPointer(0);
  for (vtkIdType i = 0; i <= count; ++i) offset[i] = i * corners;
  connectivity->SetNumberOfValues(count * corners);
  fill(connectivity->GetPointer(0));
  vtkNew<vtkCellArray> cells;
  cells->SetData(offsets, connectivity);
  return cells;
}

vtkNew<vtkIdTypeArray> numbered(vtkIdType first, vtkIdType count) {
  vtkNew<vtkIdTypeArray> ids;
  ids->SetName("cell");
  ids->SetNumberOfValues(count);
  std::iota(ids->GetPointer(0), ids->GetPointer(0) + count, first);
  return ids;
}

}  // namespace

PointArray::PointArray(vtkDataArray* array) : doubles_(vtkArrayDownCast<vtkDoubleArray>(array)) {
  if (!array || doubles_) return;
  doubles_ = vtkSmartPointer<vtkDoubleArray>::New();
  doubles_->DeepCopy(array);
}

symsurf::PointsView PointArray::view() const {
  if (!doubles_) return {};
  return {doubles_->GetPointer(0), doubles_->GetNumberOfTuples()};
}

TriangleArray::TriangleArray(vtkPolyData* data)
    : corners_(vtkSmartPointer<vtkTypeInt64Array>::New()),
      cells_(vtkSmartPointer<vtkIdTypeArray>::New()) {
  if (!data || data->GetNumberOfPolys() + data->GetNumberOfStrips() == 0) return;
  vtkNew<vtkPolyData> polygons;
  polygons->SetPoints(data->GetPoints());
  polygons->SetPolys(data->GetPolys());
  polygons->SetStrips(data->GetStrips());
  polygons->GetCellData()->AddArray(
      numbered(data->GetNumberOfVerts() + data->GetNumberOfLines(), polygons->GetNumberOfCells()));
  vtkNew<vtkTriangleFilter> divided;
  divided->SetInputData(polygons);
  divided->Update();
  corners_->DeepCopy(divided->GetOutput()->GetPolys()->GetConnectivityArray());
  cells_->DeepCopy(divided->GetOutput()->GetCellData()->GetArray(0));
}

symsurf::TrianglesView TriangleArray::view() const {
  static_assert(sizeof(symsurf::Index) == sizeof(vtkTypeInt64));
  return {reinterpret_cast<const symsurf::Index*>(corners_->GetPointer(0)),
          corners_->GetNumberOfValues() / 3};
}

void require_points(vtkCellArray* cells, vtkIdType count) {
  if (cells->GetNumberOfConnectivityIds() == 0) return;
  double range[2];
  cells->GetConnectivityArray()->GetRange(range);
  for (const double named : range)
    if (named < 0 || named >= static_cast<double>(count))
      throw symsurf::InvalidInput("a cell names point " +
                                  std::to_string(static_cast<vtkIdType>(named)) +
                                  "; allowed is 0 to " + std::to_string(count - 1));
}

PointArray points_of(vtkPolyData* data) {
  return PointArray(data && data->GetPoints() ? data->GetPoints()->GetData() : nullptr);
}

void set_points(vtkPolyData* data, const symsurf::Points& points) {
  vtkNew<vtkDoubleArray> array;
  array->SetNumberOfComponents(3);
  array->SetNumberOfTuples(points.rows());
  std::copy_n(points.data(), points.size(), array->GetPointer(0));
  vtkNew<vtkPoints> result;
  result->SetData(array);
  data->SetPoints(result);
}

void set_vertices(vtkPolyData* data, const symsurf::Points& points) {
  set_points(data, points);
  data->SetVerts(cells_of(points.rows(), 1, [&](vtkTypeInt64* ids) {
    std::iota(ids, ids + points.rows(), vtkTypeInt64{0});
  }));
}

void set_triangles(vtkPolyData* data, const symsurf::Mesh& mesh) {
  set_points(data, mesh.vertices);
  data->SetPolys(cells_of(mesh.triangles.rows(), 3, [&](vtkTypeInt64* ids) {
    std::copy_n(mesh.triangles.data(), mesh.triangles.size(), ids);
  }));
}
