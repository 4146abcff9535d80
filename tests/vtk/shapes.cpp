// The filters take every kind of data set that holds a shape.

#include <gtest/gtest.h>
#include <symsurf/mirrors.h>

#include <cmath>
#include <initializer_list>
#include <string>
#include <vector>

#include "error_listener.h"
#include "mirror_data.h"
#include "mirrored_shape.h"
#include "vtkAppendFilter.h"
#include "vtkDoubleArray.h"
#include "vtkFieldData.h"
#include "vtkImageData.h"
#include "vtkMirrorAsymmetry.h"
#include "vtkMirrorDetection.h"
#include "vtkMirrorReflection.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkPointDamage.h"
#include "vtkPointData.h"
#include "vtkRectilinearGrid.h"
#include "vtkSphereSource.h"
#include "vtkSymmetryAnalysis.h"
#include "vtkTable.h"
#include "vtkUnstructuredGrid.h"

namespace {

const symsurf::Plane upright({1, 0, 0}, -1);  // x = 1

// The triangles of a sphere, their corners moved.
vtkSmartPointer<vtkPolyData> lopsided_ball() {
  vtkNew<vtkSphereSource> sphere;
  sphere->SetThetaResolution(20);
  sphere->SetPhiResolution(12);
  sphere->SetOutputPointsPrecision(vtkAlgorithm::DOUBLE_PRECISION);
  sphere->Update();
  auto ball = vtkSmartPointer<vtkPolyData>::New();
  ball->DeepCopy(sphere->GetOutput());
  ball->GetPointData()->Initialize();
  for (vtkIdType i = 0; i < ball->GetNumberOfPoints(); ++i) {
    symsurf::Vector3 x(ball->GetPoint(i));
    x *= 1 + 0.5 * std::sin(4 * x.x() + 2 * x.y()) + 0.8 * x.y() * x.z();
    ball->GetPoints()->SetPoint(i, x.data());
  }
  return ball;
}

vtkSmartPointer<vtkPolyData> reflected(vtkPolyData* shape) {
  vtkNew<vtkMirrorReflection> reflection;
  reflection->SetInputData(shape);
  reflection->SetInputData(1, mirror_data(upright));
  reflection->Update();
  return reflection->GetOutput();
}

vtkSmartPointer<vtkUnstructuredGrid> grid_of(const std::vector<vtkDataSet*>& parts) {
  vtkNew<vtkAppendFilter> append;
  for (vtkDataSet* part : parts) append->AddInputData(part);
  append->Update();
  return append->GetOutput();
}

// In a block, beside one that is empty.
vtkSmartPointer<vtkMultiBlockDataSet> blocks_of(const std::vector<vtkDataObject*>& parts) {
  vtkNew<vtkMultiBlockDataSet> inner;
  for (vtkDataObject* part : parts) inner->SetBlock(inner->GetNumberOfBlocks(), part);
  auto outer = vtkSmartPointer<vtkMultiBlockDataSet>::New();
  outer->SetBlock(1, inner);
  return outer;
}

// Scalars that are greater inside a body that is its own image over the plane.
void set_blob(vtkDataSet* image, double background, double blob) {
  vtkNew<vtkDoubleArray> scalars;
  scalars->SetName("body");
  for (vtkIdType i = 0; i < image->GetNumberOfPoints(); ++i) {
    const symsurf::Vector3 x(image->GetPoint(i));
    const double across = std::abs(x.x() - 1) + 0.4 * x.y(), up = x.z() - 0.2 * x.y() * x.y();
    const double along = x.y() + 0.3 * x.z();
    scalars->InsertNextValue(across * across / 4 + along * along / 3 + up * up < 1 ? blob
                                                                                   : background);
  }
  image->GetPointData()->SetScalars(scalars);
}

vtkSmartPointer<vtkImageData> image_of_a_blob(double background = 0, double blob = 1) {
  auto image = vtkSmartPointer<vtkImageData>::New();
  image->SetDimensions(25, 21, 17);
  image->SetSpacing(0.25, 0.25, 0.25);
  image->SetOrigin(-2, -3, -2);
  set_blob(image, background, blob);
  return image;
}

vtkIdType points_above(vtkDataSet* image, double threshold) {
  vtkIdType count = 0;
  vtkDataArray* scalars = image->GetPointData()->GetArray("body");
  for (vtkIdType i = 0; i < image->GetNumberOfPoints(); ++i)
    count += scalars->GetComponent(i, 0) > threshold;
  return count;
}

class Detection : public testing::Test {
 protected:
  Detection() { filter->SetMethod("plane"); }

  std::string error_of(vtkDataObject* data) {
    filter->SetInputDataObject(data);
    const ErrorListener listener(filter);
    filter->Update();
    return listener.message();
  }

  void expect_the_plane(vtkDataObject* data, double tolerance) {
    EXPECT_EQ(error_of(data), "");
    vtkFieldData* fields = filter->GetOutput(vtkMirrorDetection::MIRROR)->GetFieldData();
    ASSERT_NE(fields->GetArray("Normal"), nullptr);
    const symsurf::Vector3 normal(fields->GetArray("Normal")->GetTuple3(0));
    EXPECT_NEAR(std::abs(normal.x()), 1, tolerance);
    EXPECT_NEAR(fields->GetArray("Offset")->GetComponent(0, 0) * normal.x(), -1, tolerance);
  }

  vtkIdType shape_points() {
    return filter->GetOutput(vtkMirrorDetection::SHAPE)->GetNumberOfPoints();
  }

  vtkNew<vtkMirrorDetection> filter;
};

TEST_F(Detection, OfGridsAndBlocksIsThatOfTheMesh) {
  const auto ball = lopsided_ball(), image = reflected(ball);
  const auto grid = grid_of({ball, image});
  expect_the_plane(grid, 1e-9);
  EXPECT_EQ(filter->GetOutput(vtkMirrorDetection::SHAPE)->GetNumberOfPolys(),
            2 * ball->GetNumberOfPolys());
  expect_the_plane(blocks_of({ball, image}), 1e-9);
  expect_the_plane(blocks_of({grid_of({ball}), image}), 1e-9);
  EXPECT_EQ(shape_points(), 2 * ball->GetNumberOfPoints());
}

TEST_F(Detection, OfAnImageIsThatOfThePointsAboveTheThreshold) {
  const auto mask = image_of_a_blob();
  expect_the_plane(mask, 1e-9);
  EXPECT_EQ(shape_points(), points_above(mask, 0.5));
  const auto scan = image_of_a_blob(-1000, 300);
  filter->SetImageThreshold(299);
  expect_the_plane(scan, 1e-9);
  EXPECT_EQ(shape_points(), points_above(mask, 0.5));
  filter->SetImageThreshold(300);
  EXPECT_NE(error_of(scan).find("0 points"), std::string::npos);
  filter->SetImageThreshold(0.5);
  expect_the_plane(blocks_of({mask}), 1e-9);
}

TEST_F(Detection, OfARectilinearGridToo) {
  vtkNew<vtkDoubleArray> along[3];
  for (int i = -12; i <= 12; ++i) {
    along[0]->InsertNextValue(1 + 0.2 * i + 0.002 * i * std::abs(i));
    along[1]->InsertNextValue(0.25 * i);
    along[2]->InsertNextValue(0.2 * i);
  }
  vtkNew<vtkRectilinearGrid> grid;
  grid->SetDimensions(25, 25, 25);
  grid->SetXCoordinates(along[0]);
  grid->SetYCoordinates(along[1]);
  grid->SetZCoordinates(along[2]);
  set_blob(grid, 0, 1);
  expect_the_plane(grid, 1e-9);
  EXPECT_EQ(shape_points(), points_above(grid, 0.5));
}

TEST_F(Detection, TheScalarsOfAnImageCanBeChosen) {
  const auto image = image_of_a_blob();
  vtkNew<vtkDoubleArray> other;
  other->SetName("other");
  other->SetNumberOfValues(image->GetNumberOfPoints());
  other->FillValue(0);
  image->GetPointData()->AddArray(other);
  image->GetPointData()->SetActiveScalars("other");
  EXPECT_NE(error_of(image).find("0 points"), std::string::npos);
  filter->SetInputArrayToProcess(0, 0, 0, vtkDataObject::FIELD_ASSOCIATION_POINTS, "body");
  expect_the_plane(image, 1e-9);
  EXPECT_EQ(shape_points(), points_above(image, 0.5));
}

// Two by two by two cubes: the point in the middle is on no face.
TEST_F(Detection, OfBodiesIsThatOfTheirSurface) {
  vtkNew<vtkImageData> lattice;
  lattice->SetDimensions(3, 3, 3);
  lattice->SetSpacing(1, 2, 3);
  const auto grid = grid_of({lattice});
  ASSERT_EQ(grid->GetNumberOfCells(), 8);
  EXPECT_EQ(error_of(grid), "");
  EXPECT_EQ(shape_points(), 26);
  EXPECT_EQ(filter->GetOutput(vtkMirrorDetection::SHAPE)->GetNumberOfPolys(), 24);
}

TEST_F(Detection, WhatIsNoShapeIsAnError) {
  const auto expect_error = [&](vtkDataObject* data, const char* part) {
    EXPECT_NE(error_of(data).find(part), std::string::npos) << part;
    EXPECT_EQ(filter->GetOutput()->GetNumberOfPoints(), 0);
  };
  expect_error(vtkNew<vtkTable>(), "the input is a vtkTable; allowed are vtkPolyData and");
  expect_error(blocks_of({lopsided_ball(), vtkNew<vtkTable>()}), "the input is a vtkTable");
  expect_error(blocks_of({}), "0 points");
  const auto image = image_of_a_blob();
  image->GetPointData()->SetActiveScalars(nullptr);
  expect_error(image, "the vtkImageData has no point scalars that are active");
  const auto vectors = image_of_a_blob();
  vtkNew<vtkDoubleArray> three;
  three->SetNumberOfComponents(3);
  three->SetNumberOfTuples(vectors->GetNumberOfPoints());
  vectors->GetPointData()->SetScalars(three);
  expect_error(vectors, "have 3 components; allowed is one");
  vtkNew<vtkUnstructuredGrid> broken;
  broken->SetPoints(lopsided_ball()->GetPoints());
  const vtkIdType corners[] = {0, 1, 1000000};
  broken->InsertNextCell(VTK_TRIANGLE, 3, corners);
  expect_error(broken, "a cell names point 1000000");
  expect_the_plane(image_of_a_blob(), 1e-9);
}

TEST(Shapes, TheOtherFiltersMakePolyDataOfAGrid) {
  const auto ball = lopsided_ball();
  const auto grid = grid_of({ball, reflected(ball)});
  vtkNew<vtkMirrorAsymmetry> asymmetry;
  vtkNew<vtkMirrorReflection> reflection;
  vtkNew<vtkPointDamage> damage;
  vtkNew<vtkSymmetryAnalysis> analysis;
  asymmetry->SetInputData(1, mirror_data(upright));
  reflection->SetInputData(1, mirror_data(upright));
  for (vtkShapeAlgorithm* filter :
       std::initializer_list<vtkShapeAlgorithm*>{asymmetry, reflection, damage, analysis}) {
    filter->SetInputDataObject(grid);
    const ErrorListener listener(filter);
    filter->Update();
    EXPECT_EQ(listener.message(), "") << filter->GetClassName();
    EXPECT_EQ(filter->GetOutput()->GetNumberOfPolys(), grid->GetNumberOfCells())
        << filter->GetClassName();
  }
}

}  // namespace
