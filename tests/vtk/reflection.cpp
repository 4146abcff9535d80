// A shape reflected over a mirror that was found, through the field data of the mirror alone.

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "mirrored_shape.h"
#include "vtkCubeSource.h"
#include "vtkFloatArray.h"
#include "vtkMath.h"
#include "vtkMirrorDetection.h"
#include "vtkMirrorReflection.h"
#include "vtkPointData.h"
#include "vtkSphereSource.h"

namespace {

double distance(vtkPolyData* a, vtkIdType i, vtkPolyData* b, vtkIdType j) {
  return (symsurf::Vector3(a->GetPoint(i)) - symsurf::Vector3(b->GetPoint(j))).norm();
}

// Positive where the triangles face outwards.
double enclosed_volume(vtkPolyData* data) {
  double volume = 0;
  vtkNew<vtkIdList> corners;
  for (vtkIdType cell = 0; cell < data->GetNumberOfCells(); ++cell) {
    data->GetCellPoints(cell, corners);
    const auto corner = [&](int i) { return symsurf::Vector3(data->GetPoint(corners->GetId(i))); };
    volume += corner(0).dot(corner(1).cross(corner(2))) / 6;
  }
  return volume;
}

TEST(MirrorReflection, PutsEveryPointOnItsPartnerButForTheResidual) {
  vtkNew<vtkMirrorDetection> detection;
  detection->SetInputData(polydata_of(mirrored_shape({{1, 2, -0.5}, 1.3}, 300)));
  detection->SetMethod("plane");
  vtkNew<vtkMirrorReflection> reflection;
  reflection->SetInputConnection(detection->GetOutputPort());
  reflection->SetMirrorConnection(detection->GetOutputPort(vtkMirrorDetection::MIRROR));
  reflection->Update();

  vtkPolyData* shape = detection->GetOutput(vtkMirrorDetection::SHAPE);
  vtkPolyData* reflected = reflection->GetOutput();
  ASSERT_EQ(reflected->GetNumberOfPoints(), shape->GetNumberOfPoints());
  vtkDataArray* partners = reflected->GetPointData()->GetArray("MirrorPartner");
  vtkDataArray* residuals = reflected->GetPointData()->GetArray("MirrorResidual");
  for (vtkIdType i = 0; i < reflected->GetNumberOfPoints(); ++i) {
    const auto partner = static_cast<vtkIdType>(partners->GetComponent(i, 0));
    if (partner < 0) continue;
    EXPECT_NEAR(distance(reflected, i, shape, partner), residuals->GetComponent(i, 0), 1e-12);
  }
}

TEST(MirrorReflection, KeepsTheOutsideOut) {
  vtkNew<vtkSphereSource> sphere;
  vtkNew<vtkMirrorDetection> detection;
  detection->SetInputConnection(sphere->GetOutputPort());
  detection->SetMethod("plane");
  vtkNew<vtkMirrorReflection> once, twice;
  once->SetInputConnection(sphere->GetOutputPort());
  once->SetMirrorConnection(detection->GetOutputPort(vtkMirrorDetection::MIRROR));
  twice->SetInputConnection(once->GetOutputPort());
  twice->SetMirrorConnection(detection->GetOutputPort(vtkMirrorDetection::MIRROR));
  twice->Update();

  vtkPolyData* original = sphere->GetOutput();
  EXPECT_GT(enclosed_volume(original), 0);
  EXPECT_NEAR(enclosed_volume(once->GetOutput()), enclosed_volume(original), 1e-6);
  vtkDataArray* normals = once->GetOutput()->GetPointData()->GetNormals();
  for (vtkIdType i = 0; i < original->GetNumberOfPoints(); ++i) {
    double at[3], normal[3];
    once->GetOutput()->GetPoint(i, at);
    normals->GetTuple(i, normal);
    EXPECT_GT(vtkMath::Dot(at, normal), 0.49);  // outwards: the radius is 0.5
  }
  ASSERT_EQ(twice->GetOutput()->GetNumberOfPoints(), original->GetNumberOfPoints());
  for (vtkIdType i = 0; i < original->GetNumberOfPoints(); ++i)
    EXPECT_LT(distance(twice->GetOutput(), i, original, i), 1e-12);
}

TEST(MirrorReflection, IsOverTheResultWhereCandidatesAreShown) {
  vtkNew<vtkCubeSource> cube;
  cube->SetYLength(2);
  cube->SetZLength(3);
  vtkNew<vtkMirrorDetection> detection;
  detection->SetInputConnection(cube->GetOutputPort());
  detection->SetMethod("plane");
  vtkNew<vtkMirrorReflection> reflection;
  reflection->SetInputConnection(cube->GetOutputPort());
  reflection->SetMirrorConnection(detection->GetOutputPort(vtkMirrorDetection::MIRROR));
  reflection->Update();
  vtkNew<vtkPolyData> expected;
  expected->DeepCopy(reflection->GetOutput());
  detection->ShowCandidatesOn();
  reflection->Update();
  ASSERT_EQ(reflection->GetOutput()->GetNumberOfPoints(), expected->GetNumberOfPoints());
  for (vtkIdType i = 0; i < expected->GetNumberOfPoints(); ++i)
    EXPECT_EQ(distance(reflection->GetOutput(), i, expected, i), 0);
}

}  // namespace
