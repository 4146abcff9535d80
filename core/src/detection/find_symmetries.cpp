#include <symsurf/errors.h>
#include <symsurf/symmetries.h>
#include <symsurf/value.h>

#include <chrono>

#include "detection/pipeline.h"
#include "symmetries/symmetry_search.h"

namespace symsurf {

Symmetries find_symmetries(PointsView points, const SymmetryOptions& options,
                           const Context& context) {
  if (!(options.minimum_score >= 0 && options.minimum_score <= 1))
    throw InvalidParameter("minimum_score is " + to_string(Value(options.minimum_score)) +
                           "; allowed is [0, 1]");
  const auto start = std::chrono::steady_clock::now();
  Symmetries found;
  MethodImplementation searching;  // in place of the method
  searching.name = "symmetries";
  searching.preprocessing = Preprocessing::none();
  searching.preprocessing.remove_outliers = true;
  searching.preprocessing.sample_faces = true;
  searching.preprocessing.merge_duplicates = true;
  searching.run = [&](const Cloud& cloud, const ParameterValues&, const Context& running) {
    found = search_symmetries(cloud, options.minimum_score, running);
    return Result{};
  };
  Cloud cloud;
  cloud.points = points;
  cloud.faces = options.faces;
  cloud.partition = Partition(points.size());
  run_pipeline(searching, {}, cloud, options.refuse_nonfinite, context);
  context.report(1);
  found.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return found;
}

}  // namespace symsurf
