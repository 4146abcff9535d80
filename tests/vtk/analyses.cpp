// Analyses as a filter: what the core finds, as data sets.

#include <gtest/gtest.h>
#include <symsurf/analyses.h>

#include <limits>
#include <string>

#include "error_listener.h"
#include "mirrored_shape.h"
#include "vtkCellData.h"
#include "vtkCommand.h"
#include "vtkCubeSource.h"
#include "vtkDataArray.h"
#include "vtkFieldData.h"
#include "vtkMirrorAsymmetry.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkStringArray.h"
#include "vtkSymmetryAnalysis.h"

namespace {

vtkNew<vtkPolyData> box() {
  vtkNew<vtkCubeSource> source;
  source->SetXLength(4);
  source->SetYLength(3);
  source->SetZLength(2);
  source->SetOutputPointsPrecision(vtkAlgorithm::DOUBLE_PRECISION);
  source->Update();
  vtkNew<vtkPolyData> data;
  data->DeepCopy(source->GetOutput());
  return data;
}

std::string text_of(vtkFieldData* field, const char* name) {
  return vtkArrayDownCast<vtkStringArray>(field->GetAbstractArray(name))->GetValue(0);
}

TEST(SymmetryAnalysis, FindsTheGroupOfABox) {
  vtkNew<vtkSymmetryAnalysis> filter;
  filter->SetInputData(box());
  const ErrorListener errors(filter);
  filter->Update();
  EXPECT_EQ(errors.message(), "");
  vtkFieldData* field = filter->GetOutput()->GetFieldData();
  EXPECT_EQ(text_of(field, "Analysis"), "symmetries");
  EXPECT_EQ(text_of(field, "Group"), "D2h");

  vtkPolyData* elements = filter->GetOutput(vtkSymmetryAnalysis::ELEMENTS);
  EXPECT_EQ(elements->GetNumberOfLines(), 3);
  vtkCellData* cells = elements->GetCellData();
  auto* kinds = vtkArrayDownCast<vtkStringArray>(cells->GetAbstractArray("ElementKind"));
  ASSERT_EQ(kinds->GetNumberOfValues(), elements->GetNumberOfCells());
  EXPECT_EQ(kinds->GetValue(0), "axis");
  EXPECT_EQ(kinds->GetValue(elements->GetNumberOfCells() - 1), "plane");
  EXPECT_EQ(cells->GetArray("ElementOrder")->GetTuple1(0), 2);
  double bounds[6];
  elements->GetBounds(bounds);
  for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(bounds[2 * axis], -bounds[2 * axis + 1], 1e-6);

  vtkPolyData* transformations = filter->GetOutput(vtkSymmetryAnalysis::TRANSFORMATIONS);
  ASSERT_EQ(transformations->GetNumberOfPoints(), 8);
  vtkDataArray* matrices = transformations->GetPointData()->GetArray("Matrix");
  ASSERT_EQ(matrices->GetNumberOfComponents(), 16);
  for (int component = 0; component < 16; ++component)
    EXPECT_EQ(matrices->GetComponent(0, component), component % 5 == 0);  // the identity
}

// Lines of VTK's console name the filter and the object; the errors are the core's.
TEST(SymmetryAnalysis, SaysWhatIsWrong) {
  vtkNew<vtkSymmetryAnalysis> filter;
  filter->SetInputData(box());
  filter->SetAnalysis("symmetrie");
  const ErrorListener errors(filter);
  filter->Update();
  EXPECT_NE(errors.message().find("there is no analysis 'symmetrie'"), std::string::npos);
  EXPECT_EQ(filter->GetOutput()->GetNumberOfPoints(), 0);
}

TEST(SymmetryAnalysis, WarnsOfPointsThatAreNotFinite) {
  const symsurf::Plane plane({1, 2, -0.5}, 1.3);
  symsurf::Points points = mirrored_shape(plane, 500);
  points(0, 0) = std::numeric_limits<double>::quiet_NaN();
  vtkNew<vtkSymmetryAnalysis> filter;
  filter->SetInputData(polydata_of(points));
  const ErrorListener warnings(filter, vtkCommand::WarningEvent);
  filter->Update();
  EXPECT_NE(warnings.message().find("1 points are not finite and were left out"),
            std::string::npos);
  EXPECT_EQ(text_of(filter->GetOutput()->GetFieldData(), "Group"), "Cs");

  filter->RefuseNonfiniteOn();
  const ErrorListener errors(filter);
  filter->Update();
  EXPECT_NE(errors.message().find("point 0 is"), std::string::npos);
}

TEST(SymmetryAnalysis, LaysAShapeOnASecondOne) {
  vtkNew<vtkCubeSource> second;
  second->SetXLength(3);
  second->SetYLength(2);
  second->SetZLength(4);
  vtkNew<vtkSymmetryAnalysis> filter;
  filter->SetInputData(box());
  filter->SetAnalysis("match_pair");
  const ErrorListener errors(filter);
  filter->Update();
  EXPECT_NE(errors.message().find("needs a second shape"), std::string::npos);
  filter->SetOtherConnection(second->GetOutputPort());
  filter->Update();
  vtkPolyData* shape = filter->GetOutput();
  EXPECT_EQ(text_of(shape->GetFieldData(), "Verdict"), "found");
  EXPECT_LT(shape->GetPointData()->GetArray("PairMatchingDistance")->GetRange()[1], 1e-6);
  filter->RemoveOther();
  vtkNew<vtkMirrorAsymmetry> asymmetry;
  asymmetry->SetInputData(box());
  const ErrorListener refused(asymmetry);
  asymmetry->SetOtherConnection(second->GetOutputPort());
  asymmetry->Update();
  EXPECT_LT(
      asymmetry->GetOutput()->GetPointData()->GetArray("MirrorAsymmetryDistance")->GetRange()[1],
      1e-6);
  asymmetry->RemoveOther();
  asymmetry->SetMethod("plane");
  asymmetry->SetPairing("homologous");
  vtkNew<vtkPolyData> landmarks;
  landmarks->SetPoints(second->GetOutput()->GetPoints());
  asymmetry->SetInputDataObject(3, landmarks);
  asymmetry->Update();
  EXPECT_EQ(refused.message(), "");
  vtkNew<vtkPoints> three;
  for (int i = 0; i < 3; ++i) three->InsertNextPoint(0, 0, i);
  landmarks->SetPoints(three);
  asymmetry->Update();
  EXPECT_NE(refused.message().find("3 points; allowed are two"), std::string::npos);
}

// Every analysis runs, and gives each point what it describes.
TEST(SymmetryAnalysis, RunsEveryAnalysis) {
  const vtkNew<vtkPolyData> shape = box();
  for (const symsurf::Analysis& analysis : symsurf::analyses()) {
    SCOPED_TRACE(analysis.name);
    vtkNew<vtkSymmetryAnalysis> filter;
    filter->SetInputData(shape);
    filter->SetAnalysis(analysis.name.c_str());
    if (analysis.takes_other) filter->SetInputDataObject(1, shape);
    const ErrorListener errors(filter);
    filter->Update();
    EXPECT_EQ(errors.message(), "");
    vtkPointData* data = filter->GetOutput()->GetPointData();
    EXPECT_EQ(data->GetNumberOfArrays(), shape->GetPointData()->GetNumberOfArrays() +
                                             static_cast<int>(analysis.arrays.size()));
    EXPECT_EQ(data->GetScalars() != nullptr, !analysis.shown.empty());
  }
}

}  // namespace
