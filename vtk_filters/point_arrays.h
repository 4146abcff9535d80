#ifndef point_arrays_h
#define point_arrays_h

#include <symsurf/points.h>

#include "vtkDoubleArray.h"
#include "vtkIdTypeArray.h"
#include "vtkSmartPointer.h"
#include "vtkTypeInt64Array.h"

class vtkCellArray;
class vtkDataArray;
class vtkPolyData;

namespace symsurf {
struct Mesh;
}

/// An array of three components as the core reads it: in place where it holds doubles one after
/// the other, from one copy otherwise. Null: no points.
class PointArray {
 public:
  explicit PointArray(vtkDataArray* array);

  symsurf::PointsView view() const;

 private:
  vtkSmartPointer<vtkDoubleArray> doubles_;
};

/// The corners of a data set's polygons and strips, divided into triangles. Null: none.
class TriangleArray {
 public:
  explicit TriangleArray(vtkPolyData* data);

  symsurf::TrianglesView view() const;

  /// Of each triangle, the data set's cell that it is a part of.
  vtkIdTypeArray* cells() const { return cells_; }

 private:
  vtkSmartPointer<vtkTypeInt64Array> corners_;
  vtkSmartPointer<vtkIdTypeArray> cells_;
};

/// Throws InvalidInput where a cell names a point beyond the first `count`, which VTK's own filters
/// read without asking.
void require_points(vtkCellArray* cells, vtkIdType count);

/// The data set's points; without these or a data set: an empty view.
PointArray points_of(vtkPolyData* data);

void set_points(vtkPolyData* data, const symsurf::Points& points);

/// Points, and one vertex each.
void set_vertices(vtkPolyData* data, const symsurf::Points& points);

void set_triangles(vtkPolyData* data, const symsurf::Mesh& mesh);

#endif
