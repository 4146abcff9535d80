#include "mirror_input.h"

#include <symsurf/context.h>
#include <symsurf/mirrors.h>

#include "field_values.h"
#include "vtkDataObject.h"
#include "vtkFieldData.h"
#include "vtkPolyData.h"
#include "vtkStringArray.h"

namespace {

bool has_kind(vtkFieldData* field) {
  return vtkArrayDownCast<vtkStringArray>(field->GetAbstractArray("Kind"));
}

}  // namespace

bool is_mirror(vtkDataObject* data) {
  vtkFieldData* field = data->GetFieldData();
  return field && has_kind(field) && !field->HasArray("MirrorResidualP99");
}

std::shared_ptr<symsurf::Mirror> mirror_of(vtkPolyData* data) {
  if (!is_mirror(data))
    throw symsurf::InvalidInput("the mirror " +
                                std::string(has_kind(data->GetFieldData())
                                                ? "is the shape of a mirror detection"
                                                : "has no field data array Kind") +
                                "; connect output 1 \"Mirror\" of a mirror detection");
  const symsurf::Values numbers = field_values(data->GetFieldData());
  return symsurf::make_mirror(symsurf::to_string(numbers.at("kind")), numbers);
}
