#include "described_arrays.h"

#include "vtkDoubleArray.h"
#include "vtkIdTypeArray.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkSignedCharArray.h"
#include "vtk_names.h"

namespace {

template <typename Array>
vtkSmartPointer<vtkDataArray> filled(const Eigen::MatrixXd& rows) {
  vtkNew<Array> array;
  array->SetNumberOfComponents(static_cast<int>(rows.cols()));
  array->SetNumberOfTuples(rows.rows());
  auto* value = array->GetPointer(0);
  for (Eigen::Index r = 0; r < rows.rows(); ++r)
    for (Eigen::Index c = 0; c < rows.cols(); ++c)
      *value++ = static_cast<typename Array::ValueType>(rows(r, c));
  return array;
}

}  // namespace

vtkSmartPointer<vtkDataArray> array_of(const symsurf::PointArray& described,
                                       const Eigen::MatrixXd& rows) {
  if (described.type == symsurf::ParameterType::Boolean) return filled<vtkSignedCharArray>(rows);
  if (described.type == symsurf::ParameterType::Integer) return filled<vtkIdTypeArray>(rows);
  return filled<vtkDoubleArray>(rows);
}

void add_point_arrays(vtkPolyData* output, const std::string& prefix,
                      const std::vector<symsurf::PointArray>& described,
                      const std::map<std::string, Eigen::MatrixXd>& arrays,
                      const std::string& shown) {
  for (const symsurf::PointArray& each : described) {
    const auto found = arrays.find(each.name);
    if (found == arrays.end()) continue;
    const auto array = array_of(each, found->second);
    array->SetName((prefix + vtk_name(each.name)).c_str());
    output->GetPointData()->AddArray(array);
  }
  if (!shown.empty()) output->GetPointData()->SetActiveScalars((prefix + vtk_name(shown)).c_str());
}
