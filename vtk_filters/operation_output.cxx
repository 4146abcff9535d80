#include "operation_output.h"

#include <numeric>
#include <set>
#include <vector>

#include "described_arrays.h"
#include "field_values.h"
#include "operation_names.h"
#include "point_arrays.h"
#include "point_subset.h"
#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkIdList.h"
#include "vtkIdTypeArray.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"

namespace {

using Rows = std::vector<symsurf::Index>;

void add_arrays(vtkPolyData* output, const TriangleArray& faces,
                const symsurf::OperationResult& result) {
  const symsurf::Operation& operation = symsurf::operation(result.operation);
  add_point_arrays(output, filter_name(operation), operation.arrays, result.arrays,
                   operation.shown);
  for (const symsurf::PointArray& each : operation.face_arrays)
    if (const auto found = result.face_arrays.find(each.name);
        found != result.face_arrays.end() && found->second.rows() > 0) {
      const auto array = array_of(each, found->second);
      array->SetName(array_name(operation, each.name).c_str());
      output->GetCellData()->AddArray(array);
    }
  vtkDataArray* face = output->GetPointData()->GetArray(array_name(operation, "face").c_str());
  if (!face) return;
  for (vtkIdType i = 0; i < face->GetNumberOfTuples(); ++i)  // a triangle is a part of a cell
    if (const auto triangle = static_cast<vtkIdType>(face->GetTuple1(i)); triangle >= 0)
      face->SetTuple1(i, static_cast<double>(faces.cells()->GetValue(triangle)));
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
  const bool is_other = result.is_other_shape();
  const symsurf::Index old_faces = is_other ? 0 : faces.view().size();
  for (symsurf::Index f = old_faces; f < result.faces.rows(); ++f) {
    const vtkIdType corners[] = {result.faces(f, 0), result.faces(f, 1), result.faces(f, 2)};
    added.polys->InsertNextCell(3, corners);
    added.poly_sources.push_back(faces.cells()->GetValue(result.face_sources[f]));
  }
  if (!faces.view().empty() || input->GetNumberOfVerts() == 0) return added;
  Rows vert_of(input->GetNumberOfPoints(), 0);
  vtkNew<vtkIdList> points;
  for (vtkIdType cell = 0; cell < input->GetNumberOfVerts(); ++cell) {
    input->GetVerts()->GetCellAtId(cell, points);
    for (vtkIdType i = 0; i < points->GetNumberOfIds(); ++i) vert_of[points->GetId(i)] = cell;
  }
  const vtkIdType first = is_other ? 0 : input->GetNumberOfPoints();
  for (vtkIdType p = first; p < result.points.rows(); ++p) {
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

// Points and cells in place of those of the input, with the data that lie between theirs.
void set_others(vtkPolyData* output, vtkPolyData* input, const AddedCells& made,
                const std::vector<symsurf::Index>& point_sources) {
  vtkNew<vtkCellArray> none;
  output->DeleteCells();
  output->SetLines(none);
  output->SetStrips(none);
  output->SetVerts(made.verts);
  output->SetPolys(made.polys);
  output->GetPointData()->Initialize();
  output->GetCellData()->Initialize();
  copy_rows(output->GetPointData(), input->GetPointData(), point_sources);
  copy_rows(output->GetCellData(), input->GetCellData(),
            joined({made.vert_sources, made.poly_sources}));
}

}  // namespace

vtkNew<vtkPolyData> set_operated(vtkPolyData* output, vtkPolyData* input,
                                 const TriangleArray& faces, const symsurf::OperationResult& result,
                                 const symsurf::AttributeTransform& by, const KindsByName& kinds) {
  const symsurf::Operation& operation = symsurf::operation(result.operation);
  const AddedCells cells = added_cells(input, faces, result);
  vtkPointData *data = output->GetPointData(), *given = input->GetPointData();
  output->ShallowCopy(input);
  if (operation.carries_values)
    copy_rows(data, given, result.point_sources);
  else if (result.is_other_shape())
    set_others(output, input, cells, result.point_sources);
  else if (!result.point_sources.empty())
    add_parts(output, input, cells, result.point_sources);
  carry_values(data, given, by, result.point_parents.rows() > 0, kinds);
  if (operation.carries_values) {
    data->SetNormals(given->GetNormals());
    data->SetTCoords(given->GetTCoords());
  }
  if (operation.moves_points || operation.adds_points) {
    set_points(output, result.points);
    // Of points that moved each by itself nobody knows the normals.
    if (operation.takes_mask && !by.turns()) data->SetNormals(nullptr);
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
