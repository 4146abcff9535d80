#include <utility>

#include "methods.h"

namespace symsurf {

namespace {

Result run_auto(const Cloud& cloud, const ParameterValues&, const Context& context) {
  std::vector<const Method*> tried;
  for (const Method& method : methods())
    if (method.automatic && cloud.points.size() >= method.minimum_points) tried.push_back(&method);

  Result best;
  Values scores;
  for (std::size_t i = 0; i < tried.size(); ++i) {
    const double share = 1.0 / static_cast<double>(tried.size());
    const Context part =
        context.stage(static_cast<double>(i) * share, static_cast<double>(i + 1) * share);
    const ParameterValues defaults(tried[i]->name, tried[i]->parameters, {});
    Result result = tried[i]->run(cloud, defaults, part);
    result.parameters = defaults.all();
    scores["score_" + tried[i]->name] = result.score;
    if (i == 0 || result.score > best.score) best = std::move(result);
  }
  best.statistics.merge(scores);
  return best;
}

}  // namespace

Method auto_method() {
  Method method;
  method.name = "auto";
  method.title = "Mirror (best of all kinds)";
  method.summary =
      "Tries every method that needs no advice and keeps the mirror with the best score.";
  method.run = run_auto;
  return method;
}

}  // namespace symsurf
