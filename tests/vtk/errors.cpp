// Bad input is an error event and empty outputs; the next good run works. An abort stops the run.

#include <gtest/gtest.h>
#include <symsurf/detect.h>

#include <initializer_list>
#include <limits>
#include <string>
#include <vector>

#include "bad_input/tables.h"
#include "error_listener.h"
#include "mirror_data.h"
#include "mirrored_shape.h"
#include "vtkCallbackCommand.h"
#include "vtkCellArray.h"
#include "vtkFieldData.h"
#include "vtkFloatArray.h"
#include "vtkMirrorAsymmetry.h"
#include "vtkMirrorDetection.h"
#include "vtkMirrorReflection.h"
#include "vtkMirrorSampleSource.h"
#include "vtkPointDamage.h"
#include "vtkPointData.h"
#include "vtkSymmetryAnalysis.h"
#include "vtkTable.h"

namespace {

// Runs and tells what the error said; without an error the outputs are there.
std::string error_of(vtkPolyDataAlgorithm* filter) {
  ErrorListener listener(filter);
  filter->Update();
  for (int port = 0; port < filter->GetNumberOfOutputPorts(); ++port)
    EXPECT_EQ((filter->GetOutput(port)->GetNumberOfPoints() == 0), !listener.message().empty());
  return listener.message();
}

const symsurf::Plane tilted({0.3, 1, 0.2}, 2);

TEST(FilterErrors, BadInputIsAnErrorAndALaterGoodRunWorks) {
  vtkNew<vtkMirrorDetection> filter;
  filter->SetMethod("plane");
  const vtkNew<vtkPolyData> good = polydata_of(mirrored_shape(tilted, 200));
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
  symsurf::Points broken = mirrored_shape(tilted, 10);
  broken(3, 1) = std::numeric_limits<double>::quiet_NaN();
  filter->RefuseNonfiniteOn();
  fails_with(polydata_of(broken), "point 3");
  filter->RefuseNonfiniteOff();
  broken.topRows(17).setConstant(std::numeric_limits<double>::infinity());
  fails_with(polydata_of(broken), "3 of 20 points given are finite");

  fails_with(vtkNew<vtkTable>(), "the input is a vtkTable; allowed are vtkPolyData and");
}

TEST(FilterErrors, CloudsOfTheTable) {
  vtkNew<vtkMirrorDetection> filter;
  const vtkNew<vtkPolyData> good = polydata_of(mirrored_shape(tilted, 50));
  for (const symsurf::bad_input::Cloud& cloud : symsurf::bad_input::clouds()) {
    SCOPED_TRACE(cloud.name);
    for (const symsurf::Method& method : symsurf::methods()) {
      filter->SetMethod(method.name.c_str());
      filter->SetRefuseNonfinite(cloud.refuses_nonfinite);
      filter->SetInputData(polydata_of(cloud.points));
      EXPECT_NE(error_of(filter).find(cloud.reason), std::string::npos) << method.name;
    }
    filter->SetMethod("plane");
    filter->SetInputData(good);
    EXPECT_TRUE(error_of(filter).empty());
  }
}

TEST(FilterErrors, MirrorsOfTheTable) {
  vtkNew<vtkMirrorReflection> reflection;
  const symsurf::Points points = mirrored_shape(tilted, 10);
  reflection->SetInputData(0, polydata_of(points));
  const auto said = [&](vtkPolyData* mirror) {
    reflection->SetInputData(1, mirror);
    const ErrorListener listener(reflection);
    reflection->Update();
    EXPECT_EQ(reflection->GetOutput()->GetNumberOfPoints(),
              listener.message().empty() ? points.rows() : 0);
    return listener.message();
  };
  for (const symsurf::bad_input::MirrorNumbers& mirror : symsurf::bad_input::mirrors()) {
    EXPECT_NE(said(mirror_data(mirror.kind, mirror.numbers)).find(mirror.reason), std::string::npos)
        << mirror.name;
    EXPECT_TRUE(said(mirror_data("plane", tilted.numbers())).empty());
  }
}

TEST(FilterErrors, AMirrorOfSinglePrecisionKeepsItsFractions) {
  vtkNew<vtkMirrorReflection> reflection;
  reflection->SetInputData(0, polydata_of(symsurf::Points::Zero(1, 3)));
  vtkNew<vtkPolyData> mirror =
      mirror_data("plane", {{"normal", symsurf::Vector3(1, 0, 0)}, {"offset", 0.0}});
  vtkNew<vtkFloatArray> offset;
  offset->SetName("Offset");
  offset->InsertNextValue(-0.5f);
  mirror->GetFieldData()->AddArray(offset);
  reflection->SetInputData(1, mirror);
  reflection->Update();
  EXPECT_EQ(reflection->GetOutput()->GetPoint(0)[0], 1);
}

TEST(FilterErrors, CellsThatNameNoPoint) {
  vtkNew<vtkMirrorDetection> detection;
  detection->SetMethod("plane");
  detection->UseFacesOff();  // the output has the cells nonetheless
  vtkNew<vtkMirrorReflection> reflection;
  reflection->SetInputData(
      1, mirror_data("plane", {{"normal", symsurf::Vector3(1, 0, 0)}, {"offset", 0.0}}));
  vtkNew<vtkPointDamage> damage;
  damage->SetDamage("removal");
  const symsurf::Points points = mirrored_shape(tilted, 50);
  const std::vector<vtkPolyDataAlgorithm*> filters{detection, reflection, damage};
  using Ids = std::initializer_list<vtkIdType>;
  for (const Ids& ids :
       {Ids{0, 1, 100}, {0, 1, 2, 100}, {-1, 1, 2}, {-1, 1, 2, 3}, {0, 1, 2, 3, 4000000000}})
    for (const auto set_cells : {&vtkPolyData::SetVerts, &vtkPolyData::SetLines,
                                 &vtkPolyData::SetPolys, &vtkPolyData::SetStrips}) {
      const vtkNew<vtkPolyData> shape = polydata_of(points);
      vtkNew<vtkCellArray> cells;
      cells->InsertNextCell(ids);
      (shape->*set_cells)(cells);
      for (vtkPolyDataAlgorithm* filter : filters) {
        filter->SetInputData(shape);
        EXPECT_NE(error_of(filter).find("a cell names point "), std::string::npos);
      }
    }
}

TEST(FilterErrors, NormalsThatAreNone) {
  vtkNew<vtkMirrorDetection> filter;
  filter->SetMethod("plane");
  filter->UseNormalsOn();
  const symsurf::Points points = mirrored_shape(tilted, 50);
  const auto said = [&](vtkIdType count, const symsurf::Vector3& last) {
    const vtkNew<vtkPolyData> shape = polydata_of(points);
    vtkNew<vtkDoubleArray> normals;
    normals->SetNumberOfComponents(3);
    for (vtkIdType i = 0; i < count; ++i)
      normals->InsertNextTuple((i + 1 < count ? symsurf::Vector3(0, 0, 1) : last).data());
    if (count > 0) shape->GetPointData()->SetNormals(normals);
    filter->SetInputData(shape);
    return error_of(filter);
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_NE(said(0, {0, 0, 1}).find("the input has no point normals"), std::string::npos);
  EXPECT_NE(said(99, {0, 0, 1}).find("the input has no point normals"), std::string::npos);
  EXPECT_NE(said(101, {0, 0, 1}).find("101 normals given for 100 points"), std::string::npos);
  EXPECT_NE(said(100, {0, 0, 0}).find("normal 99 is (0, 0, 0)"), std::string::npos);
  EXPECT_NE(said(100, {nan, 0, 1}).find("normal 99 is (nan, 0, 1)"), std::string::npos);
  EXPECT_NE(said(100, {0, -infinity, 1}).find("normal 99 is (0, -inf, 1)"), std::string::npos);
  EXPECT_TRUE(said(100, {0, 0, 1}).empty());
}

TEST(FilterErrors, SamplesAndDamageOfNothingKnown) {
  vtkNew<vtkMirrorSampleSource> source;
  source->SetGenerator("no such");
  {
    const ErrorListener listener(source);
    source->Update();
    EXPECT_NE(listener.message().find("'no such'"), std::string::npos);
    EXPECT_EQ(source->GetOutput()->GetNumberOfPoints(), 0);
  }
  vtkNew<vtkPointDamage> damage;
  damage->SetInputData(polydata_of(mirrored_shape(tilted, 10)));
  damage->SetDamage("no such");
  const ErrorListener listener(damage);
  damage->Update();
  EXPECT_NE(listener.message().find("'no such'"), std::string::npos);
  EXPECT_EQ(damage->GetOutput()->GetNumberOfPoints(), 0);
}

TEST(FilterErrors, WarnsOfWhatAMethodIsNotFor) {
  vtkNew<vtkMirrorDetection> filter;
  filter->SetMethod("sphere_thesis");
  filter->SetSphereThesisSampleSize(10);
  filter->SetInputData(polydata_of(mirrored_shape(tilted, 5001)));
  const ErrorListener warnings(filter, vtkCommand::WarningEvent);
  EXPECT_TRUE(error_of(filter).empty());
  EXPECT_NE(warnings.message().find("10002 points given; sphere_thesis is for"), std::string::npos);
}

TEST(FilterErrors, PointsThatAreNotFiniteAreLeftOutWithAWarning) {
  symsurf::Points points(203, 3);
  points << symsurf::Points::Constant(2, 3, std::numeric_limits<double>::quiet_NaN()),
      mirrored_shape(tilted, 100),
      symsurf::Points::Constant(1, 3, std::numeric_limits<double>::infinity());
  vtkNew<vtkMirrorDetection> filter;
  filter->SetMethod("plane");
  filter->SetInputData(polydata_of(points));
  {
    const ErrorListener warnings(filter, vtkCommand::WarningEvent);
    EXPECT_TRUE(error_of(filter).empty());
    EXPECT_NE(warnings.message().find("3 points are not finite"), std::string::npos);
  }
  vtkPointData* mapped = filter->GetOutput(vtkMirrorDetection::SHAPE)->GetPointData();
  for (const vtkIdType i : {0, 1, 202}) {
    EXPECT_EQ(mapped->GetArray("MirrorPartner")->GetComponent(i, 0), -1);
    EXPECT_EQ(mapped->GetArray("MirrorSide")->GetComponent(i, 0), 0);
  }
  for (vtkIdType i = 2; i < 202; ++i)
    EXPECT_EQ(mapped->GetArray("MirrorPartner")->GetComponent(i, 0), i < 102 ? i + 100 : i - 100);
  vtkFieldData* fields = filter->GetOutput(vtkMirrorDetection::MIRROR)->GetFieldData();
  EXPECT_EQ(fields->GetArray("NonfinitePoints")->GetComponent(0, 0), 3);
  // Without such points nothing is said.
  filter->SetInputData(polydata_of(mirrored_shape(tilted, 100)));
  const ErrorListener warnings(filter, vtkCommand::WarningEvent);
  filter->Update();
  EXPECT_TRUE(warnings.message().empty());
}

TEST(FilterErrors, BadParametersAreErrors) {
  vtkNew<vtkMirrorDetection> filter;
  filter->SetInputData(polydata_of(mirrored_shape(tilted, 200)));
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
  reflection->SetInputData(0, polydata_of(mirrored_shape(tilted, 10)));
  reflection->SetInputData(1, polydata_of(mirrored_shape(tilted, 10)));
  ErrorListener listener(reflection);
  reflection->Update();
  EXPECT_NE(listener.message().find("Kind"), std::string::npos);
  EXPECT_EQ(reflection->GetOutput()->GetNumberOfPoints(), 0);
}

TEST(FilterErrors, AMirrorIsNoShapeAndAShapeNoMirror) {
  vtkNew<vtkMirrorDetection> detection;
  detection->SetInputData(polydata_of(mirrored_shape(tilted, 100)));
  detection->SetMethod("plane");
  vtkNew<vtkMirrorSampleSource> source;
  vtkNew<vtkMirrorDetection> again;
  vtkNew<vtkMirrorReflection> reflection;
  vtkNew<vtkMirrorAsymmetry> asymmetry;
  vtkNew<vtkSymmetryAnalysis> analysis;
  vtkNew<vtkPointDamage> damage;
  vtkAlgorithmOutput* mirror = detection->GetOutputPort(vtkMirrorDetection::MIRROR);
  reflection->SetMirrorConnection(mirror);
  const auto said = [](vtkAlgorithm* filter) {
    const ErrorListener listener(filter);
    filter->Update();
    return listener.message();
  };
  for (vtkShapeAlgorithm* filter : std::initializer_list<vtkShapeAlgorithm*>{
           source, again, reflection, asymmetry, analysis, damage}) {
    SCOPED_TRACE(filter->GetClassName());
    filter->SetInputConnection(mirror);
    EXPECT_NE(said(filter).find("the input is a mirror"), std::string::npos);
    EXPECT_EQ(filter->GetOutput()->GetNumberOfPoints(), 0);
    filter->SetInputConnection(detection->GetOutputPort());
    EXPECT_EQ(said(filter), "");
  }
  reflection->SetMirrorConnection(detection->GetOutputPort());
  EXPECT_NE(said(reflection).find("is the shape of a mirror detection; connect output 1"),
            std::string::npos);
}

TEST(FilterErrors, AnAbortStopsTheRunAndEmptiesTheOutputs) {
  vtkNew<vtkMirrorDetection> filter;
  filter->SetInputData(polydata_of(mirrored_shape(tilted, 50000)));
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
  filter->SetInputData(polydata_of(mirrored_shape(tilted, 50000)));
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
