#include "methods.h"

namespace symsurf {

namespace {

// The methods stand in the order of their mirrors' freedom: past a score like this a kind that is
// freer could only explain the same in more words.
constexpr double surely_found = 0.9;

Result run_auto(const Cloud& cloud, const ParameterValues& values, const Context& context) {
  std::vector<const Method*> tried;
  for (const Method& method : methods())
    if (method.automatic && cloud.points.size() >= method.minimum_points) tried.push_back(&method);

  Result best;
  double best_score = -1;
  Values scores;
  for (std::size_t i = 0; i < tried.size() && best_score < surely_found; ++i) {
    const double share = 1.0 / static_cast<double>(tried.size());
    const Context part =
        context.stage(static_cast<double>(i) * share, static_cast<double>(i + 1) * share);
    const ParameterValues defaults(tried[i]->name, tried[i]->parameters, {});
    Result result = tried[i]->run(cloud, defaults, part);
    result.parameters = defaults.all();
    const double score = result.score;
    scores["score_" + tried[i]->name] = score;
    if (score > best_score) {
      best_score = score;
      best = std::move(result);
    }
  }
  best.statistics.merge(scores);
  best.parameters["minimum_score"] = values.real("minimum_score");
  return best;
}

}  // namespace

Method auto_method() {
  Method method;
  method.name = "auto";
  method.title = "Mirror (best of all kinds)";
  method.summary =
      "Tries kinds of mirror, simple ones first, until one convinces, keeps the one with the best "
      "score, discounted for its freedom, and says whether it is one.";
  method.run = run_auto;
  return method;
}

}  // namespace symsurf
