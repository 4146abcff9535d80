#pragma once

#include <symsurf/mirror.h>

#include <string>

#include "field_values.h"
#include "vtkNew.h"
#include "vtkPolyData.h"

/// A mirror as a detection hands it on, its numbers in the field data.
inline vtkNew<vtkPolyData> mirror_data(const std::string& kind, const symsurf::Values& numbers) {
  vtkNew<vtkPolyData> data;
  add_field_values(data->GetFieldData(), numbers);
  add_field_values(data->GetFieldData(), {{"kind", kind}});
  return data;
}

inline vtkNew<vtkPolyData> mirror_data(const symsurf::Mirror& mirror) {
  return mirror_data(std::string(mirror.kind()), mirror.numbers());
}
