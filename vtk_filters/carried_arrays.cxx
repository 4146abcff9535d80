#include "carried_arrays.h"

#include <cmath>
#include <numeric>

#include "vtkDataArray.h"
#include "vtkDataSetAttributes.h"

namespace {

using symsurf::AttributeKind;

AttributeKind kind_of(vtkDataArray* values, vtkDataSetAttributes* data) {
  if (values == data->GetVectors()) return AttributeKind::Vector;
  if (values == data->GetNormals()) return AttributeKind::Normal;
  return values == data->GetTensors() ? AttributeKind::Tensor : AttributeKind::Scalar;
}

bool is_colour(vtkDataArray* values) {
  const int components = values->GetNumberOfComponents();
  return values->GetDataType() == VTK_UNSIGNED_CHAR && (components == 3 || components == 4);
}

}  // namespace

void copy_rows(vtkDataSetAttributes* to, vtkDataSetAttributes* from,
               const std::vector<symsurf::Index>& rows) {
  const auto count = static_cast<vtkIdType>(rows.size());
  to->CopyAllOn();
  to->CopyAllocate(from, count);
  for (vtkIdType i = 0; i < count; ++i) to->CopyData(from, rows[i], i);
}

void carry_values(vtkDataSetAttributes* to, vtkDataSetAttributes* from,
                  const symsurf::AttributeTransform& by, bool blends) {
  const bool turns = by.turns() && (from->GetVectors() || from->GetNormals() || from->GetTensors());
  if (!turns && !blends) return;
  if (to->GetAbstractArray(0) == from->GetAbstractArray(0)) {  // both share them
    std::vector<symsurf::Index> rows(from->GetNumberOfTuples());
    std::iota(rows.begin(), rows.end(), symsurf::Index{0});
    to->Initialize();
    copy_rows(to, from, rows);
  }
  for (int k = 0; k < from->GetNumberOfArrays(); ++k) {
    vtkDataArray* values = from->GetArray(k);
    if (!values) continue;
    const AttributeKind kind = kind_of(values, from);
    const int type = values->GetDataType();
    const bool is_real = type == VTK_FLOAT || type == VTK_DOUBLE;
    const bool is_turned = is_real && kind != AttributeKind::Scalar && turns;
    if (!is_turned && !(blends && (is_real || is_colour(values)))) continue;
    Eigen::MatrixXd rows(values->GetNumberOfTuples(), values->GetNumberOfComponents());
    for (vtkIdType i = 0; i < rows.rows(); ++i)
      for (int c = 0; c < rows.cols(); ++c) rows(i, c) = values->GetComponent(i, c);
    rows = by(rows, kind);
    for (vtkIdType i = 0; i < rows.rows(); ++i)
      for (int c = 0; c < rows.cols(); ++c)
        to->GetArray(k)->SetComponent(i, c, is_real ? rows(i, c) : std::round(rows(i, c)));
  }
}
