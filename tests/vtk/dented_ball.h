#pragma once

#include <symsurf/mirrors.h>

#include <cmath>
#include <numbers>

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkDoubleArray.h"
#include "vtkIdTypeArray.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"

/// What mirrors the ball but for its dent.
inline const symsurf::Plane ball_mirror(symsurf::Vector3::UnitX(), 0);

inline vtkNew<vtkIdTypeArray> numbered(const char* name, vtkIdType count) {
  vtkNew<vtkIdTypeArray> ids;
  ids->SetName(name);
  for (vtkIdType i = 0; i < count; ++i) ids->InsertNextValue(i);
  return ids;
}

/// A bumpy ball over x = 0 with a dent in the side of positive x, of every kind of cell that a data
/// set may have: a vertex, a line, quadrangles, triangles at the poles and a strip around the
/// equator. Points have Id, a Mask that is 1 where y is positive, normals and texture coordinates,
/// cells have CellId.
inline vtkNew<vtkPolyData> dented_ball() {
  constexpr int meridians = 24, parallels = 15, equator = 7;
  const auto at = [](int ring, int k) { return vtkIdType{ring} * meridians + k % meridians; };
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  vtkNew<vtkDoubleArray> mask, normals, texture;
  mask->SetName("Mask");
  normals->SetName("Normals");
  normals->SetNumberOfComponents(3);
  texture->SetName("Texture");
  texture->SetNumberOfComponents(2);
  const auto add = [&](const symsurf::Vector3& u) {
    const double dent = 0.1 * std::exp(-(u - symsurf::Vector3(0.8, 0.6, 0)).squaredNorm() / 0.1);
    const double radius = 1 + 0.1 * std::sin(3 * u.y() + 1) + 0.1 * u.z() * u.x() * u.x() - dent;
    points->InsertNextPoint((radius * u).eval().data());
    mask->InsertNextValue(u.y() > 0);
    normals->InsertNextTuple(u.data());
    texture->InsertNextTuple2(u.x(), u.y());
  };
  for (int ring = 0; ring < parallels; ++ring)
    for (int k = 0; k < meridians; ++k) {
      const double around = 2 * std::numbers::pi * (k + 0.5) / meridians;
      const double down = std::numbers::pi * (ring + 1) / (parallels + 1);
      add({std::sin(down) * std::cos(around), std::sin(down) * std::sin(around), std::cos(down)});
    }
  const vtkIdType north = at(parallels, 0), south = north + 1;
  add(symsurf::Vector3::UnitZ());
  add(-symsurf::Vector3::UnitZ());

  vtkNew<vtkCellArray> verts, lines, polys, strips;
  verts->InsertNextCell({3});
  lines->InsertNextCell({4, 5, 6});
  for (int k = 0; k < meridians; ++k) {
    polys->InsertNextCell({north, at(0, k), at(0, k + 1)});
    polys->InsertNextCell({south, at(parallels - 1, k + 1), at(parallels - 1, k)});
    for (int ring = 0; ring + 1 < parallels; ++ring)
      if (ring != equator)
        polys->InsertNextCell({at(ring, k), at(ring + 1, k), at(ring + 1, k + 1), at(ring, k + 1)});
  }
  strips->InsertNextCell(2 * (meridians + 1));
  for (int k = 0; k <= meridians; ++k)
    for (const int ring : {equator, equator + 1}) strips->InsertCellPoint(at(ring, k));

  vtkNew<vtkPolyData> data;
  data->SetPoints(points);
  data->SetVerts(verts);
  data->SetLines(lines);
  data->SetPolys(polys);
  data->SetStrips(strips);
  data->GetPointData()->AddArray(numbered("Id", points->GetNumberOfPoints()));
  data->GetPointData()->AddArray(mask);
  data->GetPointData()->SetNormals(normals);
  data->GetPointData()->SetTCoords(texture);
  data->GetCellData()->AddArray(numbered("CellId", data->GetNumberOfCells()));
  return data;
}
