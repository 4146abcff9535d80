// What vtkMirrorDetection gives is the core's result, on ports and arrays as documented.

#include <gtest/gtest.h>
#include <symsurf/detect.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <vector>

#include "error_listener.h"
#include "expect_points.h"
#include "mirrored_shape.h"
#include "point_arrays.h"
#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkCubeSource.h"
#include "vtkFieldData.h"
#include "vtkFloatArray.h"
#include "vtkMirrorDetection.h"
#include "vtkPointData.h"
#include "vtkStringArray.h"

namespace {

const symsurf::Plane truth({1, 2, -0.5}, 1.3);

double number(vtkDataObject* data, const char* name) {
  return data->GetFieldData()->GetArray(name)->GetComponent(0, 0);
}

std::string text(vtkDataObject* data, const char* name) {
  vtkFieldData* fields = data->GetFieldData();
  return vtkStringArray::SafeDownCast(fields->GetAbstractArray(name))->GetValue(0);
}

TEST(MirrorDetection, TheKnownPlaneIsFound) {
  vtkNew<vtkMirrorDetection> filter;
  filter->SetInputData(polydata_of(mirrored_shape(truth, 2000)));
  filter->SetMethod("plane");
  filter->Update();
  vtkPolyData* mirror = filter->GetOutput(vtkMirrorDetection::MIRROR);
  EXPECT_GT(mirror->GetNumberOfPolys(), 0);
  for (vtkIdType i = 0; i < mirror->GetNumberOfPoints(); ++i)
    EXPECT_LT(std::abs(truth.signed_distance(symsurf::Vector3(mirror->GetPoint(i)))), 1e-9);
  EXPECT_GT(number(mirror, "Score"), 0.9);
  EXPECT_EQ(text(mirror, "Kind"), "plane");
  EXPECT_EQ(text(mirror, "Method"), "plane");
}

class EveryMethod : public testing::TestWithParam<symsurf::Method> {
 protected:
  EveryMethod() {
    symsurf::Options options;
    options.method = GetParam().name;
    // The work of this method grows with the cube of its sample.
    if (options.method == "sphere_thesis") options.parameters["sample_size"] = symsurf::Index{60};
    filter->SetSphereThesisSampleSize(60);
    expected = symsurf::detect(points, options);
    filter->SetInputData(input);
    filter->SetMethod(GetParam().name.c_str());
    filter->Update();
  }

  const symsurf::Points points = mirrored_shape(truth, 400);
  const vtkNew<vtkPolyData> input = polydata_of(points);
  symsurf::Result expected;
  vtkNew<vtkMirrorDetection> filter;
};

TEST_P(EveryMethod, GivesTheCoresMirror) {
  vtkPolyData* mirror = filter->GetOutput(vtkMirrorDetection::MIRROR);
  EXPECT_EQ(number(mirror, "Score"), expected.score);
  EXPECT_EQ(text(mirror, "Method"), expected.method);
  if (!expected.mirror) return;
  EXPECT_EQ(text(mirror, "Kind"), expected.mirror->kind());
  const symsurf::Mesh mesh = expected.mirror->mesh();
  expect_points(mirror, mesh.vertices);
  EXPECT_EQ(mirror->GetNumberOfPolys(), mesh.triangles.rows());
}

TEST_P(EveryMethod, GivesTheCoresSurfacePoints) {
  vtkPolyData* surface = filter->GetOutput(vtkMirrorDetection::SURFACE_POINTS);
  expect_points(surface, expected.surface_points);
  EXPECT_EQ(surface->GetNumberOfVerts(), expected.surface_points.rows());
  vtkDataArray* residuals = surface->GetPointData()->GetArray("Residual");
  for (symsurf::Index i = 0; i < expected.residuals.size(); ++i)
    EXPECT_EQ(residuals->GetComponent(i, 0), expected.residuals[i]);
}

TEST_P(EveryMethod, MapsTheInputOntoItself) {
  vtkPolyData* shape = filter->GetOutput(vtkMirrorDetection::SHAPE);
  EXPECT_EQ(shape->GetPoints(), input->GetPoints());
  EXPECT_EQ(input->GetPointData()->GetNumberOfArrays(), 0);
  vtkDataArray* partners = shape->GetPointData()->GetArray("MirrorPartner");
  vtkDataArray* distances = shape->GetPointData()->GetArray("MirrorResidual");
  vtkDataArray* sides = shape->GetPointData()->GetArray("MirrorSide");
  // They scatter about the mirror that lies through them.
  const std::string& name = GetParam().name;
  const bool of_midpoints =
      name == "separation" || name == "separation_normals" || name == "normals_only";
  std::vector<bool> paired(points.rows(), false);
  for (symsurf::Index row = 0; row < expected.pairs.rows(); ++row)
    paired[expected.pairs(row, 0)] = true;
  for (symsurf::Index i = 0; i < points.rows(); ++i) {
    EXPECT_EQ(partners->GetComponent(i, 0) >= 0, paired[i]);
    EXPECT_EQ(std::isnan(distances->GetComponent(i, 0)), !paired[i]);
    if (!expected.mirror || of_midpoints) continue;
    const symsurf::Vector3 x = points.row(i);
    EXPECT_GE(sides->GetComponent(i, 0) * expected.mirror->signed_distance(x), 0);
    if (!paired[i]) continue;
    const symsurf::Vector3 partner(input->GetPoint(partners->GetComponent(i, 0)));
    EXPECT_NEAR(distances->GetComponent(i, 0), (expected.mirror->reflect(x) - partner).norm(),
                1e-13);
  }
  if (expected.residuals.size() == 0) return;
  const auto residuals = expected.residuals.array();
  const double p99 = number(shape, "MirrorResidualP99");
  EXPECT_LE((residuals > p99).count(), 0.01 * residuals.size());
  EXPECT_GE((residuals >= p99).count(), 0.01 * residuals.size());
}

INSTANTIATE_TEST_SUITE_P(Methods, EveryMethod, testing::ValuesIn(symsurf::methods()),
                         [](const auto& info) { return info.param.name; });

// Six quads, and the same as twelve triangles of the core's.
TEST(MirrorDetection, PolygonsAreASurface) {
  vtkNew<vtkCubeSource> cube;
  cube->SetXLength(2);
  cube->SetYLength(3);
  cube->SetOutputPointsPrecision(vtkAlgorithm::DOUBLE_PRECISION);
  cube->Update();
  const TriangleArray faces(cube->GetOutput());
  ASSERT_EQ(faces.view().size(), 12);
  symsurf::Options options;
  options.method = "plane";
  options.faces = faces.view();
  const symsurf::Result expected = symsurf::detect(points_of(cube->GetOutput()).view(), options);
  vtkNew<vtkMirrorDetection> filter;
  filter->SetInputConnection(cube->GetOutputPort());
  filter->SetMethod("plane");
  filter->Update();
  vtkPolyData* mirror = filter->GetOutput(vtkMirrorDetection::MIRROR);
  EXPECT_EQ(number(mirror, "Score"), expected.score);
  EXPECT_GT(number(mirror, "SurfaceSamples"), 10000);
  EXPECT_EQ(text(mirror, "Verdict"), "found");
  EXPECT_EQ(text(mirror, "Reason"), expected.reason());
  expect_points(filter->GetOutput(vtkMirrorDetection::SURFACE_POINTS), expected.surface_points);
  filter->UseFacesOff();
  filter->Update();
  EXPECT_EQ(mirror->GetFieldData()->GetArray("SurfaceSamples"), nullptr);
  EXPECT_EQ(TriangleArray(nullptr).view().size(), 0);
}

class BoxOfThreePlanes : public testing::Test {
 protected:
  BoxOfThreePlanes() {
    cube->SetXLength(1);
    cube->SetYLength(2);
    cube->SetZLength(3);
    filter->SetInputConnection(cube->GetOutputPort());
    filter->SetMethod("plane");
  }

  // The axis that all points of the cells of a rank lie across; -1: none, or several.
  int axis_of(int rank) {
    symsurf::Vector3 farthest(0, 0, 0);
    vtkNew<vtkIdList> corners;
    for (vtkIdType cell = 0; cell < mirror->GetNumberOfCells(); ++cell) {
      if (mirror->GetCellData()->GetArray("Rank")->GetComponent(cell, 0) != rank) continue;
      EXPECT_NEAR(mirror->GetCellData()->GetArray("Score")->GetComponent(cell, 0), 1, 1e-9);
      mirror->GetCellPoints(cell, corners);
      for (vtkIdType i = 0; i < 3; ++i)
        farthest =
            farthest.cwiseMax(symsurf::Vector3(mirror->GetPoint(corners->GetId(i))).cwiseAbs());
    }
    if ((farthest.array() > 1e-9).count() != 2) return -1;
    return static_cast<int>(std::find(farthest.begin(), farthest.end(), farthest.minCoeff()) -
                            farthest.begin());
  }

  vtkNew<vtkCubeSource> cube;
  vtkNew<vtkMirrorDetection> filter;
  vtkPolyData* mirror = filter->GetOutput(vtkMirrorDetection::MIRROR);
};

TEST_F(BoxOfThreePlanes, CandidatesAreShownWhenAskedFor) {
  filter->Update();
  double ranks[2];
  mirror->GetCellData()->GetArray("Rank")->GetRange(ranks);
  EXPECT_EQ(ranks[1], 0);
  const int best = axis_of(0);
  filter->ShowCandidatesOn();
  filter->Update();
  mirror->GetCellData()->GetArray("Rank")->GetRange(ranks);
  EXPECT_EQ(ranks[0], 0);
  EXPECT_EQ(ranks[1], 2);
  EXPECT_EQ(axis_of(0), best);
  EXPECT_EQ((std::set{axis_of(0), axis_of(1), axis_of(2)}), (std::set{0, 1, 2}));
}

TEST_F(BoxOfThreePlanes, FieldDataHasTheNumbersOfAll) {
  filter->ShowCandidatesOn();
  filter->Update();
  vtkFieldData* fields = mirror->GetFieldData();
  EXPECT_NEAR(std::abs(fields->GetArray("Normal")->GetComponent(0, axis_of(0))), 1, 1e-9);
  ASSERT_EQ(fields->GetArray("CandidateScores")->GetNumberOfTuples(), 2);
  ASSERT_EQ(fields->GetArray("CandidateNormals")->GetNumberOfTuples(), 2);
  ASSERT_EQ(fields->GetArray("CandidateOffsets")->GetNumberOfTuples(), 2);
  for (int i = 0; i < 2; ++i) {
    const int axis = axis_of(i + 1);
    EXPECT_NEAR(fields->GetArray("CandidateScores")->GetComponent(i, 0), 1, 1e-9);
    EXPECT_NEAR(std::abs(fields->GetArray("CandidateNormals")->GetComponent(i, axis)), 1, 1e-9);
    EXPECT_NEAR(fields->GetArray("CandidateOffsets")->GetComponent(i, 0), 0, 1e-9);
  }
}

TEST(MirrorDetection, DoublesAreReadInPlaceAndFloatsCopiedOnce) {
  const vtkNew<vtkPolyData> data = polydata_of(mirrored_shape(truth, 10));
  auto* doubles = vtkDoubleArray::SafeDownCast(data->GetPoints()->GetData());
  EXPECT_EQ(points_of(data).view().data(), doubles->GetPointer(0));

  vtkNew<vtkFloatArray> floats;
  floats->DeepCopy(doubles);
  const PointArray copy(floats);
  EXPECT_EQ(copy.view().size(), 20);
  for (vtkIdType i = 0; i < 60; ++i)
    EXPECT_EQ(copy.view().data()[i], static_cast<double>(floats->GetValue(i)));
  EXPECT_TRUE(PointArray(nullptr).view().empty());
}

TEST(MirrorDetection, NormalsAreUsedWhenAskedFor) {
  const vtkNew<vtkPolyData> data = polydata_of(mirrored_shape(truth, 100));
  vtkNew<vtkFloatArray> normals;
  normals->SetName("Normals");
  normals->SetNumberOfComponents(3);
  normals->SetNumberOfTuples(200);
  normals->Fill(0);  // the core takes no normal for a direction that is none
  data->GetPointData()->SetNormals(normals);
  vtkNew<vtkMirrorDetection> filter;
  filter->SetInputData(data);
  filter->SetMethod("plane");
  filter->Update();
  EXPECT_GT(filter->GetOutput(0)->GetNumberOfPoints(), 0);
  filter->UseNormalsOn();
  const ErrorListener listener(filter);
  filter->Update();
  EXPECT_NE(listener.message().find("normal 0"), std::string::npos);
  EXPECT_EQ(filter->GetOutput(0)->GetNumberOfPoints(), 0);
}

TEST(MirrorDetection, NormalsThatAreAskedForMustBeThere) {
  vtkNew<vtkMirrorDetection> filter;
  filter->SetInputData(polydata_of(mirrored_shape(truth, 100)));
  filter->SetMethod("plane");
  filter->UseNormalsOn();
  const ErrorListener listener(filter);
  filter->Update();
  EXPECT_NE(listener.message().find("the input has no point normals"), std::string::npos);
  EXPECT_EQ(filter->GetOutput(0)->GetNumberOfPoints(), 0);
  filter->UseNormalsOff();
  filter->Update();
  EXPECT_GT(filter->GetOutput(0)->GetNumberOfPoints(), 0);
}

}  // namespace
