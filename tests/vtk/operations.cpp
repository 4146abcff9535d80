// Operations as filters: what the core gives, beside what the input has.

#include <gtest/gtest.h>
#include <symsurf/operations.h>

#include <cmath>
#include <set>

#include "dented_ball.h"
#include "error_listener.h"
#include "every_operation.h"
#include "expect_points.h"
#include "mirror_data.h"
#include "mirrored_shape.h"
#include "operation_names.h"
#include "point_arrays.h"
#include "vtkFieldData.h"
#include "vtkIdList.h"
#include "vtkMirrorDetection.h"

namespace {

symsurf::OperationResult by_core(const std::string& name, vtkPolyData* shape,
                                 const symsurf::Values& parameters = {}) {
  const PointArray points = points_of(shape);
  const TriangleArray faces(shape);
  return symsurf::operate(name, {points.view(), faces.view()}, ball_mirror, parameters);
}

void expect_equal(vtkDataArray* found, const Eigen::MatrixXd& expected) {
  ASSERT_TRUE(found);
  ASSERT_EQ(found->GetNumberOfTuples(), expected.rows());
  ASSERT_EQ(found->GetNumberOfComponents(), expected.cols());
  for (Eigen::Index r = 0; r < expected.rows(); ++r)
    for (Eigen::Index c = 0; c < expected.cols(); ++c) {
      const double value = found->GetComponent(r, static_cast<int>(c));
      EXPECT_TRUE(value == expected(r, c) || (std::isnan(value) && std::isnan(expected(r, c))))
          << found->GetName() << " " << r;
    }
}

// A mirror that comes by field data is that of the detection but for the length of its normal.
void expect_near(vtkPolyData* found, vtkPolyData* expected) {
  ASSERT_EQ(found->GetNumberOfPoints(), expected->GetNumberOfPoints());
  for (vtkIdType i = 0; i < expected->GetNumberOfPoints(); ++i)
    for (int axis = 0; axis < 3; ++axis)
      EXPECT_NEAR(found->GetPoint(i)[axis], expected->GetPoint(i)[axis], 1e-12);
}

TEST(Operations, EachIsAFilter) {
  std::set<std::string> filters, operations;
  for (const auto& [name, filter] : every_operation()) {
    EXPECT_EQ(filter->GetClassName(), "vtk" + name);
    filters.insert(name);
  }
  for (const symsurf::Operation& operation : symsurf::operations())
    operations.insert(filter_name(operation));
  EXPECT_EQ(filters, operations);
}

TEST(Operations, GiveWhatTheCoreGives) {
  const vtkNew<vtkPolyData> shape = dented_ball();
  auto filters = every_operation();
  for (const symsurf::Operation& operation : symsurf::operations()) {
    SCOPED_TRACE(operation.name);
    vtkMirrorOperation* filter = filters.at(filter_name(operation));
    filter->SetInputData(0, shape);
    filter->SetInputData(1, mirror_data(ball_mirror));
    const ErrorListener errors(filter);
    filter->Update();
    EXPECT_EQ(errors.message(), "");
    const symsurf::OperationResult expected = by_core(operation.name, shape);
    vtkPolyData* output = filter->GetOutput();
    expect_points(output, expected.points);
    for (const symsurf::PointArray& array : operation.arrays) {
      if (!expected.arrays.contains(array.name)) continue;
      vtkDataArray* found =
          output->GetPointData()->GetArray(array_name(operation, array.name).c_str());
      if (array.name != "face") expect_equal(found, expected.arrays.at(array.name));
    }
    vtkDataArray* scalars = output->GetPointData()->GetScalars();
    EXPECT_EQ(scalars ? scalars->GetName() : "",
              operation.shown.empty() ? "" : array_name(operation, operation.shown));
    for (const auto& [name, value] : expected.statistics)
      EXPECT_TRUE(output->GetFieldData()->GetAbstractArray(vtk_name(name).c_str())) << name;
  }
}

TEST(Operations, KeepCellsAndDataOfTheInput) {
  const vtkNew<vtkPolyData> shape = dented_ball();
  auto filters = every_operation();
  for (const symsurf::Operation& operation : symsurf::operations()) {
    SCOPED_TRACE(operation.name);
    vtkMirrorOperation* filter = filters.at(filter_name(operation));
    filter->SetInputData(0, shape);
    filter->SetInputData(1, mirror_data(ball_mirror));
    filter->Update();
    const symsurf::OperationResult by_the_core = by_core(operation.name, shape);
    if (by_the_core.is_other_shape()) continue;
    vtkPolyData* output = filter->GetOutput();
    vtkPointData* points = output->GetPointData();
    for (vtkIdType i = 0; i < shape->GetNumberOfPoints(); ++i) {
      EXPECT_EQ(points->GetArray("Id")->GetTuple1(i),
                operation.carries_values ? by_the_core.point_sources[i] : i);
      EXPECT_EQ(points->GetTCoords()->GetTuple2(i)[0],
                shape->GetPointData()->GetTCoords()->GetTuple2(i)[0]);
    }
    EXPECT_EQ(points->GetNormals() != nullptr, operation.name != "symmetrize");
    // What is added comes behind the cells of its own kind.
    vtkNew<vtkIdList> expected, found;
    ASSERT_GE(output->GetNumberOfCells(), shape->GetNumberOfCells());
    EXPECT_EQ(output->GetNumberOfCells() > shape->GetNumberOfCells(),
              output->GetNumberOfPoints() > shape->GetNumberOfPoints());
    const vtkIdType added = output->GetNumberOfCells() - shape->GetNumberOfCells();
    const vtkIdType strips = shape->GetNumberOfCells() - shape->GetNumberOfStrips();
    for (vtkIdType cell = 0; cell < shape->GetNumberOfCells(); ++cell) {
      const vtkIdType now = cell < strips ? cell : cell + added;
      shape->GetCellPoints(cell, expected);
      output->GetCellPoints(now, found);
      ASSERT_EQ(found->GetNumberOfIds(), expected->GetNumberOfIds());
      for (vtkIdType i = 0; i < expected->GetNumberOfIds(); ++i)
        EXPECT_EQ(found->GetId(i), expected->GetId(i));
      EXPECT_EQ(output->GetCellType(now), shape->GetCellType(cell));
      EXPECT_EQ(output->GetCellData()->GetArray("CellId")->GetTuple1(now), cell);
    }
    EXPECT_TRUE(shape->GetPointData()->GetNormals());  // the input stays as it was
    EXPECT_EQ(shape->GetPointData()->GetNumberOfArrays(), 4);
    EXPECT_EQ(shape->GetFieldData()->GetNumberOfArrays(), 0);
  }
}

// Texture coordinates lie between those of the parents, ids are those of the sources.
TEST(Operations, CarryDataToMirroredTriangles) {
  const vtkNew<vtkPolyData> shape = dented_ball();
  vtkNew<vtkMirrorSymmetrization> filter;
  filter->SetInputData(0, shape);
  filter->SetInputData(1, mirror_data(ball_mirror));
  filter->SetTriangles("mirrored");
  filter->Update();
  vtkPolyData* output = filter->GetOutput();
  const auto expected = by_core("symmetrize", shape, {{"triangles", "mirrored"}});
  expect_points(output, expected.points);
  ASSERT_EQ(output->GetNumberOfPolys(), expected.faces.rows());
  EXPECT_EQ(output->GetNumberOfStrips(), 0);
  vtkDataArray* texture = shape->GetPointData()->GetTCoords();
  const TriangleArray faces(shape);
  for (vtkIdType i = 0; i < output->GetNumberOfPoints(); ++i) {
    double between = 0;
    for (int k = 0; k < 3; ++k)
      between += expected.point_shares(i, k) * texture->GetTuple2(expected.point_parents(i, k))[0];
    EXPECT_NEAR(output->GetPointData()->GetTCoords()->GetTuple2(i)[0], between, 1e-6);
    EXPECT_EQ(output->GetPointData()->GetArray("Id")->GetTuple1(i), expected.point_sources[i]);
  }
  for (vtkIdType f = 0; f < output->GetNumberOfPolys(); ++f)
    EXPECT_EQ(output->GetCellData()->GetArray("CellId")->GetTuple1(f),
              faces.cells()->GetValue(expected.face_sources[f]));
  EXPECT_TRUE(output->GetPointData()->GetNormals());
}

TEST(Operations, FindTheMirrorWhereNoneIsConnected) {
  vtkNew<vtkMirrorDetection> detection;
  detection->SetInputData(dented_ball());
  detection->SetMethod("plane");
  for (const auto& [name, alone] : every_operation()) {
    SCOPED_TRACE(name);
    const auto connected = every_operation().at(name);
    alone->SetInputData(0, dented_ball());
    alone->SetMethod("plane");
    connected->SetInputData(0, dented_ball());
    connected->SetMirrorConnection(detection->GetOutputPort(vtkMirrorDetection::MIRROR));
    connected->SetMethod("plane");
    alone->Update();
    connected->Update();
    ASSERT_GT(alone->GetOutput()->GetNumberOfPoints(), 0);
    expect_near(alone->GetOutput(), connected->GetOutput());
    connected->RemoveMirror();
    connected->Update();
    expect_near(alone->GetOutput(), connected->GetOutput());
  }
}

TEST(Operations, AfterADetectionTakeTheShape) {
  vtkNew<vtkMirrorDetection> detection;
  detection->SetInputData(dented_ball());
  detection->SetMethod("plane");
  const auto filters = every_operation();
  vtkMirrorOperation* asymmetry = filters.at("MirrorAsymmetry");
  asymmetry->SetMethod("plane");
  const auto largest = [&] {
    asymmetry->Update();
    return asymmetry->GetOutput()->GetFieldData()->GetArray("Maximum")->GetTuple1(0);
  };
  asymmetry->SetInputConnection(0, detection->GetOutputPort());
  const double found = largest();
  asymmetry->SetInputData(1, mirror_data(ball_mirror));
  EXPECT_NEAR(found, largest(), 0.01);
  EXPECT_NEAR(found, 0.1, 0.015);  // the depth of the dent, which tilts the plane
}

TEST(Operations, AShapeIsSymmetricOnceItIsSymmetrized) {
  const auto filters = every_operation();
  vtkMirrorOperation* symmetrization = filters.at("MirrorSymmetrization");
  vtkMirrorOperation* asymmetry = filters.at("MirrorAsymmetry");
  symmetrization->SetInputData(0, dented_ball());
  symmetrization->SetInputData(1, mirror_data(ball_mirror));
  asymmetry->SetInputData(1, mirror_data(ball_mirror));
  const auto largest = [&] {
    asymmetry->Update();
    return asymmetry->GetOutput()->GetFieldData()->GetArray("Maximum")->GetTuple1(0);
  };
  asymmetry->SetInputData(0, dented_ball());
  EXPECT_GT(largest(), 0.05);
  asymmetry->SetInputConnection(0, symmetrization->GetOutputPort());
  EXPECT_LT(largest(), 1e-12);
}

TEST(Operations, PointsThatTheMaskHoldsStay) {
  const auto filters = every_operation();
  auto* filter = vtkMirrorSymmetrization::SafeDownCast(filters.at("MirrorSymmetrization"));
  const vtkNew<vtkPolyData> shape = dented_ball();
  filter->SetInputData(0, shape);
  filter->SetInputData(1, mirror_data(ball_mirror));
  filter->SetSide("negative");
  filter->SetMaskArray("Mask");
  filter->Update();
  vtkDataArray* mask = shape->GetPointData()->GetArray("Mask");
  vtkIdType moved = 0;
  for (vtkIdType i = 0; i < shape->GetNumberOfPoints(); ++i) {
    const double distance =
        (symsurf::Vector3(filter->GetOutput()->GetPoint(i)) - symsurf::Vector3(shape->GetPoint(i)))
            .norm();
    EXPECT_TRUE(mask->GetTuple1(i) == 1 || distance == 0);
    moved += distance > 0.01;
  }
  EXPECT_GT(moved, 0);
}

TEST(Operations, FacesOfCorrespondencesAreCellsOfTheInput) {
  const vtkNew<vtkPolyData> shape = dented_ball();
  const auto filter = every_operation().at("MirrorCorrespondences");
  filter->SetInputData(0, shape);
  filter->SetInputData(1, mirror_data(ball_mirror));
  filter->Update();
  vtkPointData* data = filter->GetOutput()->GetPointData();
  vtkIdType found = 0;
  vtkNew<vtkIdList> corners;
  for (vtkIdType i = 0; i < shape->GetNumberOfPoints(); ++i) {
    const auto partner =
        static_cast<vtkIdType>(data->GetArray("MirrorCorrespondencesIndex")->GetTuple1(i));
    const auto cell =
        static_cast<vtkIdType>(data->GetArray("MirrorCorrespondencesFace")->GetTuple1(i));
    EXPECT_EQ(cell < 0, partner < 0);
    if (cell < 0) continue;
    ++found;
    shape->GetCellPoints(cell, corners);
    EXPECT_GE(corners->IsId(partner), 0);
  }
  EXPECT_GT(found, shape->GetNumberOfPoints() / 2);
}

TEST(Operations, WorkOnCloudsOfSinglePrecision) {
  const symsurf::Points points = mirrored_shape(ball_mirror, 300);
  vtkNew<vtkPoints> single;  // VTK's default
  for (symsurf::Index i = 0; i < points.rows(); ++i)
    single->InsertNextPoint(points(i, 0), points(i, 1), points(i, 2));
  vtkNew<vtkPolyData> cloud;
  cloud->SetPoints(single);
  for (const auto& [name, filter] : every_operation()) {
    SCOPED_TRACE(name);
    filter->SetInputData(0, cloud);
    filter->SetInputData(1, mirror_data(ball_mirror));
    const ErrorListener errors(filter);
    filter->Update();
    if (name == "MirrorRemeshing") {
      EXPECT_NE(errors.message().find("remesh needs a mesh"), std::string::npos);
      continue;
    }
    EXPECT_EQ(errors.message(), "");
    EXPECT_GE(filter->GetOutput()->GetNumberOfPoints(),
              name == "MirrorCut" ? points.rows() / 2 : points.rows());
  }
}

}  // namespace
