#include "methods/thesis/trials.h"

#include <symsurf/errors.h>

#include <cmath>
#include <limits>

#include "base/parallel.h"
#include "methods/thesis/half_sphere.h"
#include "methods/thesis/sheet_score.h"

namespace symsurf {

namespace {

struct Trial {
  double error = 0, clearance = 0, score = 0;
  Index upper = 0, lower = 0;

  bool skipped() const { return upper == 0 || lower == 0; }
};

void fill_pairs(Result& result, PointsView points, const Separation& separation) {
  std::vector<std::int32_t> place(points.size(), -1);
  const auto count = static_cast<Index>(separation.upper.size());
  for (Index k = 0; k < count; ++k) place[separation.upper[k]] = static_cast<std::int32_t>(k);
  result.pairs.resize(count, 2);
  result.residuals.resize(count);
  result.surface_points.resize(count, 3);
  for (Index i = 0, row = 0; i < points.size(); ++i) {
    if (place[i] < 0) continue;
    const Index j = separation.partner[place[i]];
    result.pairs.row(row) << i, j;
    result.residuals[row] = std::sqrt(separation.squared()[place[i]]);
    result.surface_points.row(row++) = (points[i] + points[j]).transpose() / 2;
  }
}

Eigen::MatrixXd table(const std::vector<Vector3>& directions, const std::vector<Trial>& trials) {
  Eigen::MatrixXd rows(static_cast<Index>(trials.size()), 8);
  for (std::size_t k = 0; k < trials.size(); ++k) {
    const Trial& t = trials[k];
    rows.row(static_cast<Index>(k)) << directions[k].transpose(), t.error, t.clearance, t.score,
        static_cast<double>(t.upper), static_cast<double>(t.lower);
  }
  return rows;
}

}  // namespace

Result best_separation(const Cloud& cloud, const PointTree& tree, Index steps,
                       const std::function<double(const Separation&)>& projection_error,
                       const Context& context) {
  const std::vector<Vector3> directions = half_sphere(steps);
  const Separator separate(cloud.points, tree, context);

  std::vector<Trial> trials(directions.size());
  const auto count = static_cast<Index>(directions.size());
  constexpr Index grain = 8;
  parallel_for(context.stage(0.02, 0.95), count, grain, [&](Index begin, Index end) {
    Separation separation = separate.room();
    for (Index k = begin; k < end; ++k) {
      separate(directions[k], separation);
      Trial& trial = trials[k];
      trial.upper = static_cast<Index>(separation.upper.size());
      trial.lower = static_cast<Index>(separation.lower.size());
      if (trial.skipped()) {
        trial.error = trial.clearance = trial.score = std::numeric_limits<double>::quiet_NaN();
        continue;
      }
      trial.error = projection_error(separation);
      trial.clearance = separate.clearance(separation);
      trial.score = std::log(trial.clearance + 1) + std::exp(-trial.error);
    }
  });

  Index best = -1, skipped = 0;
  for (Index k = 0; k < count; ++k) {
    if (trials[k].skipped())
      ++skipped;
    else if (best < 0 || trials[k].score > trials[best].score)
      best = k;
  }
  if (best < 0)
    throw InvalidInput("each of the " + std::to_string(count) +
                       " planes tried leaves one side without points");

  Result result;
  Separation separation = separate.room();
  separate(directions[best], separation);
  fill_pairs(result, cloud.points, separation);
  result.score = sheet_score(cloud.points, tree, result, context.stage(0.95, 1));
  result.statistics = {
      {"direction", directions[best]},           {"projection_error", trials[best].error},
      {"clearance", trials[best].clearance},     {"thesis_score", trials[best].score},
      {"directions", table(directions, trials)}, {"skipped_directions", skipped}};
  return result;
}

Parameter direction_steps() {
  return Parameter::integer("steps", 10, 1, 1000, "",
                            "Steps over half a turn in each of the two angles of the directions "
                            "tried.");
}

}  // namespace symsurf
