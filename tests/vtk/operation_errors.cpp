// Bad input of the operations' filters is an error event and empty outputs; the next good run
// works.

#include <gtest/gtest.h>
#include <symsurf/context.h>
#include <symsurf/mirrors.h>
#include <symsurf/operations.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "bad_input/tables.h"
#include "dented_ball.h"
#include "error_listener.h"
#include "every_operation.h"
#include "mirror_data.h"
#include "mirrored_shape.h"
#include "operation_names.h"
#include "point_arrays.h"
#include "vtkCallbackCommand.h"

namespace {

// Runs and tells what the error said; without an error the first output is there.
std::string error_of(vtkMirrorOperation* filter) {
  const ErrorListener listener(filter);
  filter->Update();
  EXPECT_EQ(filter->GetOutput()->GetNumberOfPoints() == 0, !listener.message().empty());
  for (int port = 1; port < filter->GetNumberOfOutputPorts(); ++port)
    EXPECT_TRUE(listener.message().empty() || filter->GetOutput(port)->GetNumberOfPoints() == 0);
  return listener.message();
}

TEST(OperationErrors, CloudsOfTheTable) {
  for (const auto& [name, filter] : every_operation()) {
    SCOPED_TRACE(name);
    filter->SetMethod("plane");
    for (const symsurf::bad_input::Cloud& cloud : symsurf::bad_input::clouds()) {
      SCOPED_TRACE(cloud.name);
      filter->SetInputData(0, polydata_of(cloud.points));
      const std::string said = error_of(filter);
      if (cloud.refuses_nonfinite)  // some are left out: no option of operations refuses them
        EXPECT_EQ(said.find("finite"), std::string::npos) << said;
      else
        EXPECT_NE(said.find(cloud.reason), std::string::npos) << said;
    }
    filter->SetInputData(0, dented_ball());
    EXPECT_EQ(error_of(filter), "");
  }
}

TEST(OperationErrors, MirrorsOfTheTable) {
  for (const auto& [name, filter] : every_operation()) {
    SCOPED_TRACE(name);
    filter->SetInputData(0, dented_ball());
    for (const symsurf::bad_input::MirrorNumbers& mirror : symsurf::bad_input::mirrors()) {
      filter->SetInputData(1, mirror_data(mirror.kind, mirror.numbers));
      EXPECT_NE(error_of(filter).find(mirror.reason), std::string::npos) << mirror.name;
    }
    filter->SetInputData(1, vtkNew<vtkPolyData>());
    EXPECT_NE(error_of(filter).find("no field data array Kind"), std::string::npos);
    filter->SetInputData(1, mirror_data(ball_mirror));
    EXPECT_EQ(error_of(filter), "");
  }
}

// Points spread evenly over a ball with dents of which no side is like another.
symsurf::Points shape_without_mirror() {
  constexpr symsurf::Index count = 600;
  const double golden_angle = std::numbers::pi * (3 - std::sqrt(5.0));
  symsurf::Points points(count, 3);
  for (symsurf::Index i = 0; i < count; ++i) {
    const double z = 1 - (2.0 * i + 1) / count, angle = golden_angle * i;
    const double x = std::sqrt(1 - z * z) * std::cos(angle);
    const double y = std::sqrt(1 - z * z) * std::sin(angle);
    const double radius = 1 + 0.25 * std::sin(3 * y + 2 * z + 1) + 0.25 * std::cos(2 * x - 3 * y) +
                          0.15 * std::sin(4 * z - x);
    points.row(i) << radius * x, radius * y, radius * z;
  }
  return points;
}

TEST(OperationErrors, AMirrorThatIsNoneWarnsUnlessRefused) {
  const symsurf::Points points = shape_without_mirror();
  for (const auto& [name, filter] : every_operation()) {
    SCOPED_TRACE(name);
    filter->SetInputData(0, polydata_of(points));
    filter->SetMethod("plane");
    if (name == "MirrorRemeshing") {
      EXPECT_NE(error_of(filter).find("remesh needs a mesh"), std::string::npos);
      continue;
    }
    {
      const ErrorListener warnings(filter, vtkCommand::WarningEvent);
      EXPECT_EQ(error_of(filter), "");
      EXPECT_NE(warnings.message().find("score"), std::string::npos) << warnings.message();
    }
    filter->RequireFoundOn();
    const std::string said = error_of(filter);
    EXPECT_NE(said.find("the shape has no mirror: "), std::string::npos) << said;
    EXPECT_NE(said.find("score"), std::string::npos) << said;
    filter->RequireFoundOff();
    filter->SetMethod("horoscope");
    EXPECT_NE(error_of(filter).find("'horoscope'"), std::string::npos);
    filter->SetMethod(nullptr);
    EXPECT_NE(error_of(filter).find("there is no method"), std::string::npos);
  }
}

TEST(OperationErrors, PointsThatAreNotFiniteAreLeftOutWithAWarning) {
  const vtkNew<vtkPolyData> shape = dented_ball();
  shape->GetPoints()->SetPoint(7, 0, std::numeric_limits<double>::quiet_NaN(), 0);
  for (const auto& [name, filter] : every_operation()) {
    SCOPED_TRACE(name);
    filter->SetMethod("plane");
    filter->SetInputData(0, shape);
    for (const bool mirror_is_given : {false, true}) {
      if (mirror_is_given) filter->SetInputData(1, mirror_data(ball_mirror));
      const ErrorListener warnings(filter, vtkCommand::WarningEvent);
      EXPECT_EQ(error_of(filter), "");
      EXPECT_NE(warnings.message().find("1 points are not finite and were left out"),
                std::string::npos)
          << warnings.message();
      const bool is_other = name == "MirrorRemeshing" || name == "MirrorCut";
      vtkPolyData* made = filter->GetOutput();
      ASSERT_GT(made->GetNumberOfPoints(), 7);
      EXPECT_EQ(std::isnan(made->GetPoint(7)[1]), !is_other);
    }
  }
}

TEST(OperationErrors, PolygonsThatNameNoPoint) {
  const vtkNew<vtkPolyData> shape = dented_ball();
  shape->GetPolys()->InsertNextCell({0, 1, 100000});
  for (const auto& [name, filter] : every_operation()) {
    SCOPED_TRACE(name);
    filter->SetInputData(0, shape);
    EXPECT_NE(error_of(filter).find("a cell names point 100000"), std::string::npos);
  }
}

TEST(OperationErrors, AMirrorOfAnotherUnitIsRefusedWhereTheCoreRefusesIt) {
  const symsurf::Sphere far({50, 0, 0}, 1);
  const vtkNew<vtkPolyData> shape = dented_ball();
  const auto filters = every_operation();
  int refused = 0;
  for (const symsurf::Operation& operation : symsurf::operations()) {
    SCOPED_TRACE(operation.name);
    std::string expected;
    try {
      symsurf::operate(operation.name, {points_of(shape).view(), TriangleArray(shape).view()}, far);
    } catch (const symsurf::InvalidInput& error) {
      expected = error.what();
      ++refused;
    }
    vtkMirrorOperation* filter = filters.at(filter_name(operation));
    filter->SetInputData(0, shape);
    filter->SetInputData(1, mirror_data(far));
    const std::string said = error_of(filter);
    EXPECT_NE(said.find(expected), std::string::npos) << said;
    EXPECT_EQ(said.empty(), expected.empty());
  }
  EXPECT_GT(refused, 0);
}

TEST(OperationErrors, MasksThatAreNone) {
  vtkNew<vtkMirrorSymmetrization> filter;
  const vtkNew<vtkPolyData> shape = dented_ball();
  filter->SetInputData(0, shape);
  filter->SetInputData(1, mirror_data(ball_mirror));
  filter->SetMaskArray("Masc");
  EXPECT_NE(error_of(filter).find("'Masc'; allowed are the input's point arrays: Id, Mask, "
                                  "Normals, Texture"),
            std::string::npos);
  filter->SetMaskArray("Texture");
  EXPECT_NE(error_of(filter).find("'Texture', which has 2 components"), std::string::npos);
  filter->SetMaskArray("Id");
  EXPECT_NE(error_of(filter).find("mask value 2 is 2; allowed is 0 to 1"), std::string::npos);
  for (const char* name : {"Mask", "None", "", static_cast<const char*>(nullptr)}) {
    filter->SetMaskArray(name);
    EXPECT_EQ(error_of(filter), "");
  }
}

TEST(OperationErrors, ValuesOutOfRange) {
  vtkNew<vtkMirrorAsymmetry> filter;
  filter->SetInputData(0, dented_ball());
  filter->SetInputData(1, mirror_data(ball_mirror));
  filter->SetMaxAngle(91);
  EXPECT_NE(error_of(filter).find("max_angle is 91"), std::string::npos);
  filter->SetMaxAngle(90);
  filter->SetNumberOfThreads(-1);
  EXPECT_NE(error_of(filter).find("threads is -1"), std::string::npos);
  filter->SetNumberOfThreads(1);
  EXPECT_EQ(error_of(filter), "");
}

TEST(OperationErrors, AnAbortStopsTheRunAndEmptiesTheOutputs) {
  for (const auto& [name, filter] : every_operation()) {
    SCOPED_TRACE(name);
    filter->SetInputData(0, dented_ball());
    filter->SetMethod("plane");
    vtkNew<vtkCallbackCommand> abort;
    abort->SetCallback([](vtkObject* caller, unsigned long, void*, void*) {
      static_cast<vtkAlgorithm*>(caller)->SetAbortExecute(1);
    });
    filter->AddObserver(vtkCommand::ProgressEvent, abort);
    filter->Update();
    for (int port = 0; port < filter->GetNumberOfOutputPorts(); ++port)
      EXPECT_EQ(filter->GetOutput(port)->GetNumberOfPoints(), 0);
    filter->RemoveObserver(abort);
    filter->SetAbortExecute(0);
    filter->Modified();
    EXPECT_EQ(error_of(filter), "");
  }
}

TEST(OperationErrors, ProgressRisesFrom0To1) {
  for (const bool is_given : {false, true})
    for (const auto& [name, filter] : every_operation()) {
      SCOPED_TRACE(name);
      filter->SetInputData(0, dented_ball());
      filter->SetMethod("plane");
      if (is_given) filter->SetInputData(1, mirror_data(ball_mirror));
      std::vector<double> seen;
      vtkNew<vtkCallbackCommand> progress;
      progress->SetClientData(&seen);
      progress->SetCallback([](vtkObject*, unsigned long, void* list, void* fraction) {
        static_cast<std::vector<double>*>(list)->push_back(*static_cast<double*>(fraction));
      });
      filter->AddObserver(vtkCommand::ProgressEvent, progress);
      filter->Update();
      ASSERT_GE(seen.size(), 2u);
      EXPECT_EQ(seen.front(), 0);
      EXPECT_EQ(seen.back(), 1);
      for (std::size_t i = 1; i < seen.size(); ++i) EXPECT_GE(seen[i], seen[i - 1]);
    }
}

}  // namespace
