#include "field_values.h"

#include <cctype>
#include <cmath>

#include "vtkDoubleArray.h"
#include "vtkFieldData.h"
#include "vtkNew.h"
#include "vtkStringArray.h"
#include "vtkTypeInt64Array.h"
#include "vtk_names.h"

namespace {

std::string core_name(const std::string& name) {
  std::string text;
  for (const unsigned char c : name) {
    if (std::isupper(c) && !text.empty()) text += '_';
    text += static_cast<char>(std::tolower(c));
  }
  return text;
}

using Array = vtkSmartPointer<vtkAbstractArray>;

Array numbers(const Eigen::MatrixXd& rows) {
  vtkNew<vtkDoubleArray> array;
  array->SetNumberOfComponents(static_cast<int>(rows.cols()));
  array->SetNumberOfTuples(rows.rows());
  for (Eigen::Index r = 0; r < rows.rows(); ++r)
    for (Eigen::Index c = 0; c < rows.cols(); ++c)
      array->SetComponent(r, static_cast<int>(c), rows(r, c));
  return array;
}

Array field_array(const symsurf::Value& value) {
  struct {
    Array operator()(bool v) const { return (*this)(symsurf::Index(v)); }
    Array operator()(symsurf::Index v) const {
      vtkNew<vtkTypeInt64Array> array;
      array->InsertNextValue(v);
      return array;
    }
    Array operator()(double v) const { return numbers(Eigen::MatrixXd::Constant(1, 1, v)); }
    Array operator()(const std::string& v) const {
      vtkNew<vtkStringArray> array;
      array->InsertNextValue(v);
      return array;
    }
    Array operator()(const symsurf::Vector3& v) const { return numbers(v.transpose()); }
    Array operator()(const Eigen::MatrixXd& v) const { return numbers(v); }
  } const convert;
  return std::visit(convert, value);
}

symsurf::Value value_of(vtkAbstractArray* array) {
  if (auto* strings = vtkArrayDownCast<vtkStringArray>(array))
    return std::string(strings->GetValue(0));
  auto* data = vtkArrayDownCast<vtkDataArray>(array);
  if (array->GetNumberOfValues() == 1) {
    const double value = data->GetComponent(0, 0);
    const bool is_real = array->GetDataType() == VTK_DOUBLE || array->GetDataType() == VTK_FLOAT;
    const bool is_index = !is_real && std::abs(value) < 0x1p63;
    return is_index ? symsurf::Value(static_cast<symsurf::Index>(value)) : symsurf::Value(value);
  }
  if (array->GetNumberOfTuples() == 1 && array->GetNumberOfComponents() == 3)
    return symsurf::Vector3(data->GetTuple3(0));
  Eigen::MatrixXd rows(data->GetNumberOfTuples(), data->GetNumberOfComponents());
  for (Eigen::Index r = 0; r < rows.rows(); ++r)
    for (Eigen::Index c = 0; c < rows.cols(); ++c)
      rows(r, c) = data->GetComponent(r, static_cast<int>(c));
  return rows;
}

}  // namespace

void add_field_values(vtkFieldData* field, const symsurf::Values& values) {
  for (const auto& [name, value] : values) {
    const Array array = field_array(value);
    array->SetName(vtk_name(name).c_str());
    field->AddArray(array);
  }
}

symsurf::Values field_values(vtkFieldData* field) {
  symsurf::Values values;
  for (int i = 0; i < field->GetNumberOfArrays(); ++i) {
    vtkAbstractArray* array = field->GetAbstractArray(i);
    const bool known =
        vtkArrayDownCast<vtkStringArray>(array) || vtkArrayDownCast<vtkDataArray>(array);
    if (known && array->GetName() && array->GetNumberOfValues() > 0)
      values[core_name(array->GetName())] = value_of(array);
  }
  return values;
}
