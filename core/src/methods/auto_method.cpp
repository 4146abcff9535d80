#include <symsurf/free_form.h>

#include <algorithm>
#include <optional>

#include "cloud/cloud.h"
#include "cloud/surface_points.h"
#include "methods/nearest_simple.h"
#include "methods/registry.h"
#include "preprocess/volumetric.h"

namespace symsurf {

namespace {

// A plane that scores as much leaves freer mirrors nothing to explain: skulls, a cow and an
// airplane score 0.8 and more as they are, 0.6 and less once bent about a cylinder of three
// diagonals' radius.
constexpr double enough = 0.75;
// Explained share of the shape that a freer kind has to gain. On 24 bent bodies of 10,000 points
// with noise of 0 to 1 % the right simple mirror explained 0.03 less than the free form at most,
// the best of the wrong ones 0.26 less at least, where a mirror was found.
constexpr double tie = 0.01, free_form_gain = 0.12;
constexpr double well_explained = 0.6;  // by a free form
constexpr double another_shape = 0.01;  // diagonals between mirrors, root mean square
constexpr Index thinned_size = 20000;   // points that freer kinds are tried on
constexpr Index bent_size = 100000;     // a free form of these takes hardly longer than of so few
constexpr Index few = 1000;             // points whose score tells little

// Only where every point has an exact partner: else a freer mirror may improve on it.
bool is_exact(const Result& result) { return result.score >= 1; }

// Beside a plane that maps the shape well, yet not each point onto another, a mirror that does may
// hide where the score looks least closely: among few points, and inside bodies.
bool may_hide_exact_one(const Cloud& cloud, const Context& context) {
  return cloud.points.size() <= few ||
         (cloud.points.size() <= thinned_size && is_volumetric(cloud, context));
}

std::string text(double score) { return to_string(Value(std::round(100 * score) / 100)); }

// Points of the cloud, dense where it is dense.
class ThinnedCloud {
 public:
  ThinnedCloud(const Cloud& cloud, const Context& context) : cloud_(cloud) {
    if (cloud.points.size() <= thinned_size) return;
    const std::vector<Index> rows = spread_along_curve(cloud.points, thinned_size, context);
    points_ = chosen_rows(cloud.points, rows);
    normals_ = chosen_rows(cloud.normals, rows);
    cloud_ = checked_cloud(points_, normals_, 1, context);
    cloud_.seed = cloud.seed;
    is_thinner_ = true;
  }
  const Cloud& cloud() const { return cloud_; }
  bool is_thinner() const { return is_thinner_; }

 private:
  Points points_, normals_ = Points(0, 3);
  Cloud cloud_;
  bool is_thinner_ = false;
};

Result run_with_defaults(const MethodImplementation& method, const Cloud& cloud,
                         const Context& context) {
  const ParameterValues defaults(method.name, method.parameters, {});
  Result result = method.run(cloud, defaults, context);
  result.parameters = defaults.all();
  return result;
}

double explained(const Result& result) {
  const auto share = result.statistics.find("explained_share");
  return share == result.statistics.end() ? 0 : std::get<double>(share->second);
}

// The one evaluation of all kinds: the share of the shape that they explain, less a prior on their
// freedom. The score would not do: it answers whether chance explains a mirror, not which fits.
bool explains_more(const Result& freer, const Result& simpler) {
  if (!freer.mirror || !simpler.mirror) return !simpler.mirror;
  if (freer.mirror->kind() != "free-form") return freer.score > simpler.score + tie;
  return explained(freer) > explained(simpler) + free_form_gain;
}

// A free form that maps the shape well and better than what is simpler, and is far from all mirrors
// of a kind: none of these comes near it.
bool is_ruled_out(std::string_view kind, const Result& free_form, const Result& simpler,
                  const Cloud& cloud) {
  if (!free_form.mirror || explained(free_form) < well_explained ||
      !explains_more(free_form, simpler))
    return false;
  const auto& mirror = dynamic_cast<const FreeForm&>(*free_form.mirror);
  const double distance =
      kind == "sphere" ? distance_from_sphere(mirror) : distance_from_cylinder(mirror);
  return distance > another_shape * cloud.diagonal;
}

Result run_auto(const Cloud& cloud, const ParameterValues& values, const Context& context) {
  const MethodImplementation& plane = implementation("plane");
  Result best = run_with_defaults(plane, cloud, context.stage(0, 0.2));
  Values scores{{"score_plane", best.score}};
  std::string reason;
  const bool content = best.score >= enough;
  const std::string contented = "plane scores " + text(best.score) + ": at least " + text(enough) +
                                ", which leaves freer mirrors nothing to explain";
  if (is_exact(best)) {
    reason = "every point has an exact partner over the plane";
  } else if (content && !may_hide_exact_one(cloud, context.stage(0.2, 0.2))) {
    reason = contented;
  } else {
    const ThinnedCloud thinned(cloud, context.stage(0.2, 0.2));
    const MethodImplementation* winner = &plane;
    std::string others = "plane " + text(explained(best));
    double done = 0.2, least_score = 0;
    // Beside a plane that maps the shape well a free form meets hardly each point. Elsewhere it
    // comes first: it says which of the others may fit.
    std::optional<Result> free_form;
    const MethodImplementation& bending = implementation("perpendicular");
    const bool bends_all = cloud.points.size() <= bent_size;
    if (!content && cloud.points.size() >= bending.minimum_points) {
      free_form =
          run_with_defaults(bending, bends_all ? cloud : thinned.cloud(), context.stage(done, 0.5));
      done = 0.5;
    }
    for (const MethodImplementation& freer : implementations()) {
      if (!freer.automatic || freer.name == plane.name) continue;
      if (cloud.points.size() < freer.minimum_points) continue;
      if (is_exact(best)) break;
      const bool is_free_form = freer.name == bending.name;
      if (is_free_form && !free_form) continue;
      if (!is_free_form && free_form && is_ruled_out(freer.name, *free_form, best, cloud)) continue;
      Result result = is_free_form ? std::move(*free_form)
                                   : run_with_defaults(freer, thinned.cloud(),
                                                       context.stage(done, done + 0.15));
      if (!is_free_form) done += 0.15;
      scores["score_" + freer.name] = result.score;
      others += ", " + freer.name + " " + text(explained(result));
      if (!(is_exact(result) ? result.score > best.score : !content && explains_more(result, best)))
        continue;
      // Simple mirrors are free forms too: one that explains more is no less certain.
      least_score = std::max(least_score, best.score);
      best = std::move(result);
      winner = &freer;
    }
    const bool saw_all = winner == &plane || (winner == &bending && bends_all);
    if (!saw_all && thinned.is_thinner())
      best = run_with_defaults(*winner, cloud, context.stage(done, 1));
    if (best.mirror) best.score = std::max(best.score, least_score);
    reason = content && winner == &plane
                 ? contented
                 : winner->name + " is the simplest of those that explain most: " + others;
  }
  scores["reason"] = reason;
  best.statistics.merge(scores);
  best.parameters["minimum_score"] = values.real("minimum_score");
  return best;
}

}  // namespace

MethodImplementation auto_method() {
  MethodImplementation method;
  method.name = "auto";
  method.title = "Mirror (best of all kinds)";
  method.summary =
      "Finds the plane, and where that leaves something to explain tries freer kinds of mirror; of "
      "those that fit alike the simplest is the result.";
  method.run = run_auto;
  return method;
}

}  // namespace symsurf
