// The sample source and the damage give what the core gives, with cells and data that belong.

#include <gtest/gtest.h>
#include <symsurf/synthetic.h>

#include "error_listener.h"
#include "expect_points.h"
#include "mirrored_shape.h"
#include "vtkCellArray.h"
#include "vtkDataArray.h"
#include "vtkMirrorReflection.h"
#include "vtkMirrorSampleSource.h"
#include "vtkPointDamage.h"
#include "vtkPointData.h"
#include "vtkSphereSource.h"

namespace {

symsurf::Points points_in(vtkPolyData* data) {
  symsurf::Points points(data->GetNumberOfPoints(), 3);
  for (symsurf::Index i = 0; i < points.rows(); ++i)
    points.row(i) = symsurf::Vector3(data->GetPoint(i)).transpose();
  return points;
}

class EveryGenerator : public testing::TestWithParam<symsurf::Generator> {};

TEST_P(EveryGenerator, GivesTheCoresSampleAndItsMirror) {
  const symsurf::Sample expected = symsurf::generate(GetParam().name);
  vtkNew<vtkMirrorSampleSource> source;
  source->SetGenerator(GetParam().name.c_str());
  source->Update();
  vtkPolyData* sample = source->GetOutput(vtkMirrorSampleSource::SAMPLE);
  expect_points(sample, expected.points);
  EXPECT_EQ(sample->GetNumberOfVerts(), expected.points.rows());
  vtkDataArray* partners = sample->GetPointData()->GetArray("MirrorPartner");
  for (symsurf::Index row = 0; row < expected.pairs.rows(); ++row) {
    EXPECT_EQ(partners->GetComponent(expected.pairs(row, 0), 0), expected.pairs(row, 1));
    EXPECT_EQ(partners->GetComponent(expected.pairs(row, 1), 0), expected.pairs(row, 0));
  }
  vtkPolyData* mirror = source->GetOutput(vtkMirrorSampleSource::MIRROR);
  EXPECT_GT(mirror->GetNumberOfPolys(), 0);
}

INSTANTIATE_TEST_SUITE_P(Generators, EveryGenerator, testing::ValuesIn(symsurf::generators()),
                         [](const auto& info) { return info.param.name; });

TEST(MirrorSampleSource, MirrorsTheInputWhereThereIsOne) {
  vtkNew<vtkSphereSource> sphere;
  vtkNew<vtkMirrorSampleSource> source;
  source->SetInputConnection(sphere->GetOutputPort());
  source->SetGenerator("fixed");
  source->SetFixedShift(7);
  source->Update();
  const symsurf::Sample expected =
      symsurf::generate("fixed", {{"shift", 7.0}}, points_in(sphere->GetOutput()));
  expect_points(source->GetOutput(), expected.points);
}

TEST(MirrorSampleSource, ReportsWhatIsNotAllowed) {
  vtkNew<vtkMirrorSampleSource> source;
  source->SetPerpendicularResolution(1);
  source->SetGenerator("perpendicular");
  const ErrorListener listener(source);
  source->Update();
  EXPECT_NE(listener.message().find("resolution is 1"), std::string::npos);
  EXPECT_EQ(source->GetOutput()->GetNumberOfPoints(), 0);
}

TEST(MirrorReflection, LeavesOutWhatHasNoImage) {
  vtkNew<vtkSphereSource> shape;
  shape->SetRadius(3);
  shape->SetThetaResolution(30);
  shape->SetPhiResolution(30);
  shape->SetCenter(2, 0, 0);
  vtkNew<vtkMirrorSampleSource> source;  // for its mirror, a sphere
  source->SetGenerator("spherical");
  vtkNew<vtkMirrorReflection> reflection;
  reflection->SetInputConnection(shape->GetOutputPort());
  reflection->SetMirrorConnection(source->GetOutputPort(vtkMirrorSampleSource::MIRROR));
  reflection->Update();
  vtkPolyData* reflected = reflection->GetOutput();
  EXPECT_GT(reflected->GetNumberOfPoints(), 0);
  EXPECT_LT(reflected->GetNumberOfPoints(), shape->GetOutput()->GetNumberOfPoints());
  EXPECT_GT(reflected->GetNumberOfPolys(), 0);
  EXPECT_TRUE(points_in(reflected).allFinite());
}

class EveryDamage : public testing::TestWithParam<symsurf::Damage> {};

TEST_P(EveryDamage, GivesTheCoresPointsAndKeepsWholeCells) {
  vtkNew<vtkSphereSource> sphere;
  sphere->SetThetaResolution(40);
  sphere->SetPhiResolution(40);
  vtkNew<vtkPointDamage> damage;
  damage->SetInputConnection(sphere->GetOutputPort());
  damage->SetDamage(GetParam().name.c_str());
  damage->SetSeed(3);
  damage->Update();
  vtkPolyData* before = sphere->GetOutput();
  vtkPolyData* after = damage->GetOutput();
  const symsurf::Damaged expected = symsurf::damage(GetParam().name, points_in(before), {}, 3);
  expect_points(after, expected.points);
  EXPECT_FALSE(after->GetPointData()->GetNormals());

  std::vector<bool> kept(before->GetNumberOfPoints(), false);
  for (const symsurf::Index row : expected.kept) kept[row] = true;
  vtkIdType whole = 0;
  vtkNew<vtkIdList> corners;
  for (vtkIdType cell = 0; cell < before->GetNumberOfCells(); ++cell) {
    before->GetCellPoints(cell, corners);
    whole += kept[corners->GetId(0)] && kept[corners->GetId(1)] && kept[corners->GetId(2)];
  }
  EXPECT_EQ(after->GetNumberOfPolys(), whole);
}

INSTANTIATE_TEST_SUITE_P(Damages, EveryDamage, testing::ValuesIn(symsurf::damages()),
                         [](const auto& info) { return info.param.name; });

}  // namespace
