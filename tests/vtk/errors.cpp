// Bad input is an error event and empty outputs; the next good run works. An abort stops the run.

#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <vector>

#include "error_listener.h"
#include "mirrored_shape.h"
#include "vtkCallbackCommand.h"
#include "vtkCellArray.h"
#include "vtkFieldData.h"
#include "vtkMirrorDetection.h"
#include "vtkMirrorReflection.h"
#include "vtkPointData.h"
#include "vtkUnstructuredGrid.h"

namespace {

// Runs and tells what the error said; without an error the outputs are there.
std::string error_of(vtkMirrorDetection* filter) {
  ErrorListener listener(filter);
  filter->Update();
  for (int port = 0; port < 3; ++port)
    EXPECT_EQ((filter->GetOutput(port)->GetNumberOfPoints() == 0), !listener.message().empty());
  return listener.message();
}

const symsurf::Plane truth({0.3, 1, 0.2}, 2);

TEST(FilterErrors, BadInputIsAnErrorAndALaterGoodRunWorks) {
  vtkNew<vtkMirrorDetection> filter;
  filter->SetMethod("plane");
  const vtkNew<vtkPolyData> good = polydata_of(mirrored_shape(truth, 200));
  const auto fails_with = [&](vtkDataObject* input, const char* part) {
    filter->SetInputDataObject(input);
    EXPECT_NE(error_of(filter).find(part), std::string::npos);
    filter->SetInputData(good);
    EXPECT_TRUE(error_of(filter).empty());
  };

  {
    vtkNew<vtkMirrorDetection> alone;
    EXPECT_NE(error_of(alone).find("0 connections"), std::string::npos);
  }
  fails_with(vtkNew<vtkPolyData>(), "0 points");
  fails_with(polydata_of(symsurf::Points::Ones(1, 3)), "1 points");
  fails_with(polydata_of(symsurf::Points::Ones(9, 3)), "equal");
  symsurf::Points line(9, 3);
  for (int i = 0; i < 9; ++i) line.row(i) << i, 2 * i, 3 * i;
  const vtkNew<vtkPolyData> polyline = polydata_of(line);
  vtkNew<vtkCellArray> lines;
  lines->InsertNextCell({0, 1, 2, 3, 4, 5, 6, 7, 8});
  polyline->SetLines(lines);
  fails_with(polyline, "line");
  symsurf::Points broken = mirrored_shape(truth, 10);
  broken(3, 1) = std::numeric_limits<double>::quiet_NaN();
  filter->RefuseNonfiniteOn();
  fails_with(polydata_of(broken), "point 3");
  filter->RefuseNonfiniteOff();
  broken.topRows(17).setConstant(std::numeric_limits<double>::infinity());
  fails_with(polydata_of(broken), "3 of 20 points given are finite");

  vtkNew<vtkMirrorDetection> fresh;  // VTK refuses the type itself and leaves earlier outputs
  fresh->SetInputDataObject(vtkNew<vtkUnstructuredGrid>());
  EXPECT_NE(error_of(fresh).find("vtkPolyData"), std::string::npos);
}

TEST(FilterErrors, PointsThatAreNotFiniteAreLeftOutWithAWarning) {
  symsurf::Points points(203, 3);
  points << symsurf::Points::Constant(2, 3, std::numeric_limits<double>::quiet_NaN()),
      mirrored_shape(truth, 100),
      symsurf::Points::Constant(1, 3, std::numeric_limits<double>::infinity());
  vtkNew<vtkMirrorDetection> filter;
  filter->SetMethod("plane");
  filter->SetInputData(polydata_of(points));
  {
    const ErrorListener warnings(filter, vtkCommand::WarningEvent);
    EXPECT_TRUE(error_of(filter).empty());
    EXPECT_NE(warnings.message().find("3 points are not finite"), std::string::npos);
  }
  vtkPointData* mapped = filter->GetOutput(vtkMirrorDetection::MAPPING)->GetPointData();
  for (const vtkIdType i : {0, 1, 202}) {
    EXPECT_EQ(mapped->GetArray("MirrorPartner")->GetComponent(i, 0), -1);
    EXPECT_EQ(mapped->GetArray("MirrorSide")->GetComponent(i, 0), 0);
  }
  for (vtkIdType i = 2; i < 202; ++i)
    EXPECT_EQ(mapped->GetArray("MirrorPartner")->GetComponent(i, 0), i < 102 ? i + 100 : i - 100);
  vtkFieldData* fields = filter->GetOutput(vtkMirrorDetection::MIRROR)->GetFieldData();
  EXPECT_EQ(fields->GetArray("NonfinitePoints")->GetComponent(0, 0), 3);
  // Without such points nothing is said.
  filter->SetInputData(polydata_of(mirrored_shape(truth, 100)));
  const ErrorListener warnings(filter, vtkCommand::WarningEvent);
  filter->Update();
  EXPECT_TRUE(warnings.message().empty());
}

TEST(FilterErrors, BadParametersAreErrors) {
  vtkNew<vtkMirrorDetection> filter;
  filter->SetInputData(polydata_of(mirrored_shape(truth, 200)));
  filter->SetMethod("no such");
  EXPECT_NE(error_of(filter).find("'no such'"), std::string::npos);
  filter->SetMethod(nullptr);
  EXPECT_NE(error_of(filter).find("there is no method"), std::string::npos);
  filter->SetMethod("plane");
  filter->SetPlanePairDistance(-1);
  EXPECT_NE(error_of(filter).find("pair_distance is -1"), std::string::npos);
  filter->SetPlanePairDistance(std::numeric_limits<double>::quiet_NaN());
  EXPECT_NE(error_of(filter).find("pair_distance is nan"), std::string::npos);
  filter->SetPlanePairDistance(0.1);
  filter->SetNumberOfThreads(-1);
  EXPECT_NE(error_of(filter).find("threads is -1"), std::string::npos);
  filter->SetNumberOfThreads(1);
  EXPECT_TRUE(error_of(filter).empty());
}

TEST(FilterErrors, AReflectionNeedsAMirror) {
  vtkNew<vtkMirrorReflection> reflection;
  reflection->SetInputData(0, polydata_of(mirrored_shape(truth, 10)));
  reflection->SetInputData(1, polydata_of(mirrored_shape(truth, 10)));
  ErrorListener listener(reflection);
  reflection->Update();
  EXPECT_NE(listener.message().find("Kind"), std::string::npos);
  EXPECT_EQ(reflection->GetOutput()->GetNumberOfPoints(), 0);
}

TEST(FilterErrors, AnAbortStopsTheRunAndEmptiesTheOutputs) {
  vtkNew<vtkMirrorDetection> filter;
  filter->SetInputData(polydata_of(mirrored_shape(truth, 50000)));
  filter->SetMethod("plane");
  vtkNew<vtkCallbackCommand> abort;
  int reports_after = 0;
  abort->SetClientData(&reports_after);
  abort->SetCallback([](vtkObject* caller, unsigned long, void* reports, void* fraction) {
    const double done = *static_cast<double*>(fraction);
    if (done == 0 || done == 1) return;  // the executive's own, at the start and the end
    auto* algorithm = static_cast<vtkAlgorithm*>(caller);
    *static_cast<int*>(reports) += algorithm->GetAbortExecute();
    algorithm->SetAbortExecute(1);
  });
  filter->AddObserver(vtkCommand::ProgressEvent, abort);
  filter->Update();
  for (int port = 0; port < 3; ++port) EXPECT_EQ(filter->GetOutput(port)->GetNumberOfPoints(), 0);
  EXPECT_EQ(reports_after, 0);
  filter->RemoveObserver(abort);
  filter->SetAbortExecute(0);
  filter->Modified();
  EXPECT_TRUE(error_of(filter).empty());
}

TEST(FilterErrors, ProgressRisesFrom0To1) {
  vtkNew<vtkMirrorDetection> filter;
  filter->SetInputData(polydata_of(mirrored_shape(truth, 50000)));
  filter->SetMethod("plane");
  std::vector<double> seen;
  vtkNew<vtkCallbackCommand> progress;
  progress->SetClientData(&seen);
  progress->SetCallback([](vtkObject*, unsigned long, void* list, void* fraction) {
    static_cast<std::vector<double>*>(list)->push_back(*static_cast<double*>(fraction));
  });
  filter->AddObserver(vtkCommand::ProgressEvent, progress);
  filter->Update();
  EXPECT_GT(seen.size(), 2u);
  EXPECT_EQ(seen.front(), 0);
  EXPECT_EQ(seen.back(), 1);
  for (std::size_t i = 1; i < seen.size(); ++i) EXPECT_GE(seen[i], seen[i - 1]);
}

}  // namespace
