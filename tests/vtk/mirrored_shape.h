#pragma once

#include <symsurf/mirrors.h>

#include <cmath>
#include <random>

#include "vtkDoubleArray.h"
#include "vtkNew.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"

/// A lopsided blob and its reflection over the plane, n points each, drawn at random.
inline symsurf::Points mirrored_shape(const symsurf::Plane& plane, symsurf::Index n,
                                      unsigned seed = 1) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  symsurf::Points points(2 * n, 3);
  for (symsurf::Index i = 0; i < n; ++i) {
    symsurf::Vector3 x(normal(random), normal(random), normal(random));
    x.normalize();
    x *= 1 + 0.3 * std::sin(3 * x.x() + x.y()) + 0.2 * x.y() * x.z() + 0.15 * x.x();
    points.row(i) = x.transpose();
    points.row(n + i) = plane.reflect(x).transpose();
  }
  return points;
}

inline vtkNew<vtkPolyData> polydata_of(const symsurf::Points& points) {
  vtkNew<vtkPoints> vtk_points;
  vtk_points->SetDataTypeToDouble();
  for (symsurf::Index i = 0; i < points.rows(); ++i)
    vtk_points->InsertNextPoint(points(i, 0), points(i, 1), points(i, 2));
  vtkNew<vtkPolyData> data;
  data->SetPoints(vtk_points);
  return data;
}
