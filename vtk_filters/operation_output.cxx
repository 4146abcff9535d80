#include "operation_output.h"

#include <numeric>
#include <set>
#include <vector>

#include "field_values.h"
#include "operation_names.h"
#include "point_arrays.h"
#include "point_subset.h"
#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkDoubleArray.h"
#include "vtkIdList.h"
#include "vtkIdTypeArray.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkSignedCharArray.h"

namespace {

using Rows = std::vector<symsurf::Index>;

template <typename Array>
vtkSmartPointer<vtkDataArray> filled(const Eigen::MatrixXd& rows) {
  vtkNew<Array> array;
  array->SetNumberOfComponents(static_cast<int>(rows.cols()));
  array->SetNumberOfTuples(rows.rows());
  auto* value = array->GetPointer(0);
  for (Eigen::Index r = 0; r < rows.rows(); ++r)
    for (Eigen::Index c = 0; c < rows.cols(); ++c)
      *value++ = static_cast<typename Array::ValueType>(rows(r, c));
  return array;
}

vtkSmartPointer<vtkDataArray> array_of(symsurf::ParameterType type, const Eigen::MatrixXd& rows) {
  if (type == symsurf::ParameterType::Boolean) return filled<vtkSignedCharArray>(rows);
  if (type == symsurf::ParameterType::Integer) return filled<vtkIdTypeArray>(rows);
  return filled<vtkDoubleArray>(rows);
}

void add_arrays(vtkPolyData* output, const TriangleArray& faces,
                const symsurf::OperationResult& result) {
  const symsurf::Operation& operation = symsurf::operation(result.operation);
  for (const symsurf::PointArray& described : operation.arrays) {
    const auto found = result.arrays.find(described.name);
    if (found == result.arrays.end()) continue;
    const auto array = array_of(described.type, found->second);
    array->SetName(array_name(operation, described.name).c_str());
    output->GetPointData()->AddArray(array);
    if (described.name == "face")  // a triangle is a part of a cell
      for (vtkIdType i = 0; i < array->GetNumberOfTuples(); ++i)
        if (const auto face = static_cast<vtkIdType>(array->GetTuple1(i)); face >= 0)
          array->SetTuple1(i, static_cast<double>(faces.cells()->GetValue(face)));
  }
  if (!operation.shown.empty())
    output->GetPointData()->SetActiveScalars(array_name(operation, operation.shown).c_str());
}

void copy_rows(vtkDataSetAttributes* to, vtkDataSetAttributes* from, const Rows& rows) {
  const auto count = static_cast<vtkIdType>(rows.size());
  to->CopyAllOn();
  to->CopyAllocate(from, count);
  for (vtkIdType i = 0; i < count; ++i) to->CopyData(from, rows[i], i);
}

vtkNew<vtkCellArray> joined(vtkCellArray* first, vtkCellArray* second) {
  vtkNew<vtkCellArray> cells;
  cells->DeepCopy(first);
  cells->Append(second);
  return cells;
}

// The cells of an input are numbered by kind: those that are added come behind their own kind.
struct AddedCells {
  vtkNew<vtkCellArray> verts, polys;
  Rows vert_sources, poly_sources;  // cells of the input
};

AddedCells added_cells(vtkPolyData* input, const TriangleArray& faces,
                       const symsurf::OperationResult& result) {
  AddedCells added;
  const symsurf::Index old_faces = faces.view().size();
  for (symsurf::Index f = old_faces; f < result.faces.rows(); ++f) {
    const vtkIdType corners[] = {result.faces(f, 0), result.faces(f, 1), result.faces(f, 2)};
    added.polys->InsertNextCell(3, corners);
    added.poly_sources.push_back(faces.cells()->GetValue(result.face_sources[f]));
  }
  if (old_faces > 0 || input->GetNumberOfVerts() == 0) return added;
  Rows vert_of(input->GetNumberOfPoints(), 0);
  vtkNew<vtkIdList> points;
  for (vtkIdType cell = 0; cell < input->GetNumberOfVerts(); ++cell) {
    input->GetVerts()->GetCellAtId(cell, points);
    for (vtkIdType i = 0; i < points->GetNumberOfIds(); ++i) vert_of[points->GetId(i)] = cell;
  }
  for (vtkIdType p = input->GetNumberOfPoints(); p < result.points.rows(); ++p) {
    added.verts->InsertNextCell(1, &p);
    added.vert_sources.push_back(vert_of[result.point_sources[p]]);
  }
  return added;
}

Rows range(symsurf::Index begin, symsurf::Index end) {
  Rows rows(end - begin);
  std::iota(rows.begin(), rows.end(), begin);
  return rows;
}

Rows joined(const std::vector<Rows>& parts) {
  Rows all;
  for (const Rows& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

// Points and cells behind those of the input, with the data of their sources.
void add_parts(vtkPolyData* output, vtkPolyData* input, const AddedCells& added,
               const std::vector<symsurf::Index>& point_sources) {
  output->DeleteCells();  // the index of the cells, which the input shares
  output->SetVerts(joined(input->GetVerts(), added.verts));
  output->SetPolys(joined(input->GetPolys(), added.polys));
  const symsurf::Index verts = input->GetNumberOfVerts(), cells = input->GetNumberOfCells();
  const symsurf::Index strips = cells - input->GetNumberOfStrips();
  output->GetPointData()->Initialize();
  output->GetCellData()->Initialize();
  copy_rows(output->GetPointData(), input->GetPointData(), point_sources);
  copy_rows(output->GetCellData(), input->GetCellData(),
            joined({range(0, verts), added.vert_sources, range(verts, strips), added.poly_sources,
                    range(strips, cells)}));
}

}  // namespace

vtkNew<vtkPolyData> set_operated(vtkPolyData* output, vtkPolyData* input,
                                 const TriangleArray& faces,
                                 const symsurf::OperationResult& result) {
  const symsurf::Operation& operation = symsurf::operation(result.operation);
  const AddedCells cells = added_cells(input, faces, result);
  output->ShallowCopy(input);
  if (!result.point_sources.empty()) add_parts(output, input, cells, result.point_sources);
  if (operation.moves_points || operation.adds_points) {
    set_points(output, result.points);
    output->GetPointData()->SetNormals(nullptr);
    output->GetCellData()->SetNormals(nullptr);
  }
  add_arrays(output, faces, result);
  add_field_values(output->GetFieldData(), result.statistics);

  vtkNew<vtkPolyData> added;
  added->SetPoints(output->GetPoints());
  added->GetPointData()->ShallowCopy(output->GetPointData());
  added->GetFieldData()->ShallowCopy(output->GetFieldData());
  added->SetVerts(cells.verts);
  added->SetPolys(cells.polys);
  copy_rows(added->GetCellData(), input->GetCellData(),
            joined({cells.vert_sources, cells.poly_sources}));
  added->GetCellData()->SetNormals(nullptr);
  return added;
}

void set_patch(vtkPolyData* patch, vtkPolyData* added, symsurf::Index first_added) {
  std::set<symsurf::Index> used;
  for (symsurf::Index p = first_added; p < added->GetNumberOfPoints(); ++p) used.insert(p);
  vtkNew<vtkIdList> corners;
  for (vtkIdType cell = 0; cell < added->GetNumberOfPolys(); ++cell) {
    added->GetPolys()->GetCellAtId(cell, corners);
    for (vtkIdType i = 0; i < corners->GetNumberOfIds(); ++i) used.insert(corners->GetId(i));
  }
  const Rows kept(used.begin(), used.end());
  set_subset(patch, added, points_of(added).view().matrix()(kept, Eigen::indexing::all), kept);
}
