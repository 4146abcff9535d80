#include "mirror_input.h"

#include <symsurf/context.h>
#include <symsurf/mirrors.h>

#include "field_values.h"
#include "vtkPolyData.h"

std::shared_ptr<symsurf::Mirror> mirror_of(vtkPolyData* data) {
  const symsurf::Values numbers = field_values(data->GetFieldData());
  const auto kind = numbers.find("kind");
  if (kind == numbers.end())
    throw symsurf::InvalidInput(
        "the mirror has no field data array Kind; connect the output \"Mirror\" of a mirror "
        "detection");
  return symsurf::make_mirror(symsurf::to_string(kind->second), numbers);
}
