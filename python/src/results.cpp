#include "results.h"

#include <memory>
#include <utility>

#include "arrays.h"
#include "values.h"

namespace symsurf::python {

py::dict to_python(Result&& result) {
  const auto kept = std::make_shared<Result>(std::move(result));
  py::list candidates;
  for (Result& candidate : kept->candidates) candidates.append(to_python(std::move(candidate)));
  kept->candidates.clear();

  py::dict fields;
  fields["method"] = kept->method;
  fields["mirror"] = kept->mirror;
  fields["surface_points"] = shared_array(kept->surface_points, kept);
  fields["pairs"] = shared_array(kept->pairs, kept);
  fields["residuals"] = shared_array(kept->residuals, kept);
  fields["score"] = kept->score;
  fields["candidates"] = candidates;
  fields["parameters"] = to_python(kept->parameters);
  fields["statistics"] = to_python(kept->statistics);
  fields["seconds"] = kept->seconds;
  return fields;
}

}  // namespace symsurf::python
