#include "carried_arrays.h"

#include <symsurf/detect.h>

#include <cmath>
#include <numeric>
#include <sstream>

#include "vtkDataArray.h"
#include "vtkDataSetAttributes.h"

namespace {

using symsurf::AttributeKind;

const KindsByName kinds_by_word{{"vector", AttributeKind::Vector},
                                {"normal", AttributeKind::Normal},
                                {"tensor", AttributeKind::Tensor},
                                {"scalar", AttributeKind::Scalar}};

AttributeKind kind_of(vtkDataArray* values, vtkDataSetAttributes* data, const KindsByName& kinds) {
  if (const char* name = values->GetName())
    if (const auto given = kinds.find(name); given != kinds.end()) return given->second;
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

KindsByName kinds_of(const std::string& text, vtkDataSetAttributes* data) {
  KindsByName kinds;
  std::istringstream parts(text);
  for (std::string part; std::getline(parts, part, ',');) {
    const std::size_t equals = part.rfind('=');
    const auto kind = equals == std::string::npos ? kinds_by_word.end()
                                                  : kinds_by_word.find(part.substr(equals + 1));
    const std::string name = part.substr(0, equals);
    if (kind == kinds_by_word.end() || !data->GetArray(name.c_str()))
      throw symsurf::InvalidParameter(
          "Kinds has '" + part +
          "'; allowed is NAME=KIND with a point array of the input and vector, normal, tensor or "
          "scalar");
    kinds[name] = kind->second;
  }
  return kinds;
}

void carry_values(vtkDataSetAttributes* to, vtkDataSetAttributes* from,
                  const symsurf::AttributeTransform& by, bool blends, const KindsByName& kinds) {
  const bool turns = by.turns() && (from->GetVectors() || from->GetNormals() ||
                                    from->GetTensors() || !kinds.empty());
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
    const AttributeKind kind = kind_of(values, from, kinds);
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
