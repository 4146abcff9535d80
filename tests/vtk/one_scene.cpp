// The mirrors of one scene by the core and by vtkMirrorDetection, a line a number: front end,
// method, name, values. For the test that compares all front ends.
//
//   one_scene POINTS METHOD...      POINTS: a file of doubles, three a point

#include <symsurf/detect.h>

#include <fstream>
#include <iostream>
#include <iterator>
#include <string>
#include <vector>

#include "vtkDataArray.h"
#include "vtkDoubleArray.h"
#include "vtkFieldData.h"
#include "vtkMirrorDetection.h"
#include "vtkNew.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"

namespace {

symsurf::Points read(const char* path) {
  std::ifstream file(path, std::ios::binary);
  const std::vector<char> bytes{std::istreambuf_iterator<char>(file), {}};
  return Eigen::Map<const symsurf::Points>(reinterpret_cast<const double*>(bytes.data()),
                                           static_cast<symsurf::Index>(bytes.size() / 24), 3);
}

struct Print {
  void operator()(const symsurf::Vector3& v) const {
    std::cout << " " << v.x() << " " << v.y() << " " << v.z();
  }
  void operator()(double v) const { std::cout << " " << v; }
  void operator()(symsurf::Index v) const { std::cout << " " << v; }
  void operator()(bool v) const { std::cout << " " << v; }
  void operator()(const std::string& v) const { std::cout << " " << v; }
  void operator()(const Eigen::MatrixXd& m) const {
    for (Eigen::Index row = 0; row < m.rows(); ++row)
      for (Eigen::Index column = 0; column < m.cols(); ++column) std::cout << " " << m(row, column);
  }
};

symsurf::Values by_core(const symsurf::Points& points, const std::string& method) {
  symsurf::Options options;
  options.method = method;
  const symsurf::Result result = symsurf::detect(points, options);
  symsurf::Values values = result.mirror->numbers();
  values["score"] = result.score;
  values.merge(symsurf::candidate_values(result));
  return values;
}

vtkNew<vtkPolyData> polydata_of(symsurf::Points& points) {
  vtkNew<vtkDoubleArray> coordinates;
  coordinates->SetNumberOfComponents(3);
  coordinates->SetArray(points.data(), points.size(), 1);
  vtkNew<vtkPoints> vtk_points;
  vtk_points->SetData(coordinates);
  vtkNew<vtkPolyData> data;
  data->SetPoints(vtk_points);
  return data;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3) return 2;
  symsurf::Points points = read(argv[1]);
  const vtkNew<vtkPolyData> data = polydata_of(points);
  std::cout.precision(17);
  for (const std::string method : std::vector<std::string>(argv + 2, argv + argc)) {
    for (const auto& [name, value] : by_core(points, method)) {
      std::cout << "core " << method << " " << name;
      std::visit(Print(), value);
      std::cout << "\n";
    }
    vtkNew<vtkMirrorDetection> detection;
    detection->SetInputData(data);
    detection->SetMethod(method.c_str());
    detection->Update();
    vtkFieldData* field = detection->GetOutput(vtkMirrorDetection::MIRROR)->GetFieldData();
    for (int i = 0; i < field->GetNumberOfArrays(); ++i) {
      vtkDataArray* array = field->GetArray(i);  // null: texts
      if (!array) continue;
      std::cout << "vtk " << method << " " << array->GetName();
      for (vtkIdType row = 0; row < array->GetNumberOfTuples(); ++row)
        for (int column = 0; column < array->GetNumberOfComponents(); ++column)
          std::cout << " " << array->GetComponent(row, column);
      std::cout << "\n";
    }
  }
}
