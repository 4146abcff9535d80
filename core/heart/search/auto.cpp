#include "search/auto.h"

#include <symsurf/mirrors.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "base/linear_algebra.h"
#include "base/parallel.h"
#include "cloud/cloud.h"
#include "pairing/matching.h"
#include "preprocess/boundary.h"
#include "score/mirror_score.h"
#include "score/verdict.h"
#include "search/methods.h"

namespace symsurf {

namespace {

// Of what has a counterpart over it, that a mirror maps.
constexpr double enough = 0.95;
// For a mirror with so many numbers more (MirrorScore::nats): below it straight skulls bend.
constexpr double decisive = 20;
constexpr double numbers_of_oblique_plane = 2, numbers_of_sphere = 1, numbers_of_others = 3,
                 numbers_of_free_form = 12;
constexpr std::size_t planes_bent = 3;  // the best ones
constexpr double another_shape = 0.01;  // diagonals between mirrors, root mean square
constexpr Index thinned_size = 20000;   // points that freer kinds are tried on
constexpr Index bent_size = 100000;     // a free form of these takes hardly longer than of so few

// Beside a plane that maps the shape well, yet not each point onto another, a mirror that does may
// hide where the score looks least closely: inside bodies.
bool may_hide_exact_one(const Cloud& cloud, const Context& context) {
  return cloud.points.size() <= thinned_size && is_volumetric(cloud, context);
}

std::string text(double score) { return to_string(Value(std::round(100 * score) / 100)); }

ParameterValues usual_values(const MethodImplementation& method, bool pairs) {
  return {method.name, method.parameters, {{"pairs", pairs}}};
}

Result run_usual(const MethodImplementation& method, const Cloud& cloud, bool pairs,
                 const Context& context) {
  const ParameterValues values = usual_values(method, pairs);
  Result result = method.run(cloud, values, context);
  result.parameters = values.all();
  return result;
}

double explained(const Result& result) { return statistic(result, "explained_share"); }

double covered(const Result& result) { return statistic(result, "covered_share"); }

bool maps_enough(const Result& result) {
  return result.mirror && explained(result) >= enough * covered(result);
}

bool is_found(const Result& result) {
  return result.score >= usual_minimum_score && result.mirror &&
         statistic(result, "evidence") >=
             least_evidence(*result.mirror, statistic(result, "missing_share"));
}

// Which of two mirrors is meant.
class Comparison {
 public:
  Comparison(const Cloud& cloud, const Context& context) : score_(cloud, context) {}

  bool explains_more(const Result& freer, const Result& simpler) const {
    if (!freer.mirror || !simpler.mirror) return !simpler.mirror;
    if (is_found(freer) != is_found(simpler)) return is_found(freer);
    if (is_exact(freer)) return !is_exact(simpler);
    return score_.nats(*freer.mirror, *simpler.mirror, numbers_of(freer) - numbers_of(simpler)) >
           decisive;
  }

 private:
  static double numbers_of(const Result& result) {
    const std::string_view kind = result.mirror->kind();
    return kind == "plane"           ? 0
           : kind == "oblique plane" ? numbers_of_oblique_plane
           : kind == "sphere"        ? numbers_of_sphere
           : kind == "free-form"     ? numbers_of_free_form
                                     : numbers_of_others;
  }

  MirrorScore score_;
};

using Kinds = BentPlanes::Kinds;

Kinds simple_kinds(Index points) {
  Kinds kinds;
  for (const MethodImplementation& kind : heart_methods())
    if (kind.distance_from && points >= kind.minimum_points) kinds.push_back(&kind);
  return kinds;
}

// Those that a mirror comes near, the nearest first.
Kinds near_kinds(const Kinds& kinds, const Mirror& mirror, double diagonal) {
  const auto& free_form = dynamic_cast<const FreeForm&>(mirror);
  std::vector<std::pair<double, const MethodImplementation*>> near;
  for (const MethodImplementation* kind : kinds) {
    const double distance = kind->distance_from(free_form);
    if (distance <= another_shape * diagonal) near.push_back({distance, kind});
  }
  std::stable_sort(near.begin(), near.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  Kinds ordered;
  for (const auto& [distance, kind] : near) ordered.push_back(kind);
  return ordered;
}

// The best of the kinds so far, and what was tried.
struct Contest {
  using Run = std::function<Result(const Cloud&, const Context&)>;

  bool pairs;  // whether the result is to have some
  Result best = {};
  const MethodImplementation* winner = nullptr;
  Run of_all = {};  // finds the winner again, on all points; none where it saw them
  std::vector<std::pair<std::string, double>> shares = {};  // the greatest of each kind tried
  bool content = false;  // one maps enough: what is freer has nothing to explain

  void take(const MethodImplementation& kind, Result result, bool wins, Run again) {
    content = content || (maps_enough(result) && explained(result) >= explained(best));
    tell(kind.name, explained(result));
    if (!wins) return;
    best = std::move(result);
    winner = &kind;
    of_all = std::move(again);
  }

  void tell(const std::string& kind, double share) {
    const auto known = std::find_if(shares.begin(), shares.end(),
                                    [&](const auto& one) { return one.first == kind; });
    if (known == shares.end())
      shares.push_back({kind, share});
    else
      known->second = std::max(known->second, share);
  }

  std::string tried() const {
    std::string all;
    for (const auto& [kind, share] : shares) {
      if (!all.empty()) all += ", ";
      all += kind + " " + text(share);
    }
    return all;
  }
};

Contest::Run anew(const MethodImplementation& kind, bool pairs) {
  return [&kind, pairs](const Cloud& cloud, const Context& context) {
    return run_usual(kind, cloud, pairs, context);
  };
}

// Beside a mirror that maps the shape well a free form meets hardly each point: only exact mirrors
// of other kinds count. Elsewhere it comes first, as it says which of them may fit.
void try_freer_kinds(const Cloud& cloud, bool content, const Comparison& comparison,
                     Contest& contest, const Context& context) {
  double done = 0;
  const auto thinner = [&]() -> const Cloud& {
    return cloud.thinned(thinned_size, context.stage(done, done));
  };
  const auto wins = [&](const Result& result) {
    return is_exact(result) ? !is_exact(contest.best)
                            : !content && comparison.explains_more(result, contest.best);
  };
  const MethodImplementation& bending = heart_method("perpendicular");
  const bool bends_all = cloud.points.size() <= bent_size;
  Kinds kinds = simple_kinds(cloud.points.size());
  std::optional<Result> free_form;
  if (!content && cloud.points.size() >= bending.minimum_points) {
    free_form = run_usual(bending, bends_all ? cloud : thinner(), bends_all && contest.pairs,
                          context.stage(0, 0.4));
    done = 0.4;
  }
  const bool leading = free_form && is_found(*free_form) && wins(*free_form);
  if (leading) kinds = near_kinds(kinds, *free_form->mirror, cloud.diagonal);
  const bool all = cloud.points.size() <= (leading ? bent_size : thinned_size);
  std::vector<Result> results(kinds.size());
  const auto run = [&](Index k) {
    results[k] = run_usual(*kinds[k], all ? cloud : thinner(), all && contest.pairs,
                           context.stage(done, done + 0.2));
  };
  const bool at_once = context.threads() > 1 && !is_exact(contest.best);
  if (at_once)
    silent_parallel_for(context, static_cast<Index>(kinds.size()), 1,
                        [&](Index k, Index) { run(k); });
  for (std::size_t k = 0; k < kinds.size(); ++k) {
    if (is_exact(contest.best)) break;
    if (leading && !wins(*free_form)) break;
    if (!at_once) run(static_cast<Index>(k));
    done += 0.2;
    const bool is_best = wins(results[k]);
    contest.take(*kinds[k], std::move(results[k]), is_best,
                 all ? Contest::Run() : anew(*kinds[k], contest.pairs));
  }
  if (!free_form || is_exact(contest.best)) return;
  const bool is_best = wins(*free_form);
  contest.take(bending, std::move(*free_form), is_best,
               bends_all ? Contest::Run() : anew(bending, contest.pairs));
}

bool is_oblique(const Mirror& plane) {
  constexpr double least =
      2 * std::numbers::pi / 180;  // a cut tilts chords of straight bodies by 1
  const Foot foot = *plane.at(Vector3::Zero());
  return foot.normal.cross(plane.direction(foot)).norm() > std::sin(least);
}

void try_oblique_plane(const Cloud& cloud, const Comparison& comparison, Contest& contest,
                       const Context& context) {
  const MethodImplementation& oblique = heart_method("oblique_plane");
  if (cloud.points.size() < oblique.minimum_points) return;
  const Cloud& some = cloud.thinned(thinned_size, context.stage(0, 0));
  Result result = run_usual(oblique, some, contest.pairs, context);
  const bool wins =
      result.mirror && is_oblique(*result.mirror) && comparison.explains_more(result, contest.best);
  contest.take(oblique, std::move(result), wins,
               &some == &cloud ? Contest::Run() : anew(oblique, contest.pairs));
}

// What the planes are bent into, on no more points than tell.
void try_bent_planes(const Cloud& cloud, const Comparison& comparison, Contest& contest,
                     const Context& context) {
  std::vector planes{contest.best.mirror};
  for (const Result& other : contest.best.candidates)
    if (planes.size() < planes_bent) planes.push_back(other.mirror);
  const BentPlanes bent(cloud.thinned(thinned_size, context.stage(0, 0.2)),
                        context.stage(0.2, 0.5));
  const Kinds kinds = simple_kinds(cloud.points.size());
  for (const auto& plane : planes) {
    Result result = bent.best_of(kinds, *plane);
    if (!result.mirror) continue;
    const MethodImplementation& kind = heart_method(result.method);
    const bool wins = comparison.explains_more(result, contest.best);
    const ParameterValues values = usual_values(kind, contest.pairs);
    contest.take(kind, std::move(result), wins,
                 [&kind, plane, values](const Cloud& whole, const Context& c) {
                   return BentPlanes(whole, c.stage(0, 0.5))
                       .with_pairs(kind, *plane, values, c.stage(0.5, 1));
                 });
  }
}

Result run_auto(const Cloud& cloud, const ParameterValues& values, const Context& context) {
  const MethodImplementation& plane = heart_method("plane");
  const bool pairs = values.boolean("pairs");
  Contest contest{pairs};
  contest.take(plane, run_usual(plane, cloud, pairs, context.stage(0, 0.2)), true, {});
  std::string reason = "the plane maps a share of " + text(explained(contest.best)) +
                       " of the shape onto it, and " + text(1 - covered(contest.best)) +
                       " has no counterpart: a more general mirror cannot improve on it";
  if (is_exact(contest.best)) {
    reason = "every point has an exact partner over the plane";
  } else {
    const Comparison comparison(cloud, context.stage(0.2, 0.2));
    if (!contest.content) try_oblique_plane(cloud, comparison, contest, context.stage(0.2, 0.2));
    if (!contest.content) try_bent_planes(cloud, comparison, contest, context.stage(0.2, 0.3));
    const bool content = maps_enough(contest.best) || (contest.content && is_found(contest.best));
    if (!content || may_hide_exact_one(cloud, context.stage(0.3, 0.3)))
      try_freer_kinds(cloud, content, comparison, contest, context.stage(0.3, 0.9));
    if (contest.of_all) contest.best = contest.of_all(cloud, context.stage(0.9, 1));
    if (contest.shares.size() > 1)
      reason = contest.winner->name +
               " is the simplest of those that explain most of the shape: " + contest.tried();
  }
  contest.best.statistics.try_emplace("reason", reason);
  contest.best.parameters["minimum_score"] = values.real("minimum_score");
  contest.best.parameters["tolerance"] = values.real("tolerance");
  return contest.best;
}

}  // namespace

MethodImplementation auto_method() {
  MethodImplementation method;
  method.name = "auto";
  method.title = "Mirror (best of all kinds)";
  method.summary =
      "Finds the mirror plane and, if that leaves part of the shape unexplained, tries more "
      "general mirrors; the result is the simplest of those that fit equally well.";
  method.run = run_auto;
  return method;
}

namespace {

constexpr Index sample_size = 700;   // surfels, as many as the searches for these kinds take
constexpr double least_bend = 0.01;  // inverse diagonals: over half a diagonal, .1 % high

}  // namespace

BentPlanes::BentPlanes(const Cloud& cloud, const Context& context)
    : cloud_(cloud),
      points_(cloud, context.stage(0, 0.3)),
      // In braces the patches are made in this order, as they report their progress.
      refinement_{cloud, points_, cloud.patches(sample_size, context.stage(0.3, 0.5)),
                  cloud.patches(samples_a_patch * sample_size, context.stage(0.5, 0.6))},
      score_(cloud, context.stage(0.6, 1)) {}

Result BentPlanes::best_of(const Kinds& kinds, const Mirror& plane) const {
  const PlaneBend bend = bend_of(plane);
  return std::abs(bend.greater) < least_bend ? Result() : best_of(kinds, bend);
}

Result BentPlanes::best_of(const Kinds& kinds, const PlaneBend& bend) const {
  Result best;
  MirrorFit most{.share = -1};
  for (const MethodImplementation* kind : kinds) {
    const std::shared_ptr<Mirror> mirror = kind->bent_from(bend, refinement_, cloud_.frame);
    const MirrorFit fit = score_.fit(*mirror);
    if (fit.share <= most.share) continue;
    most = fit;
    best.method = kind->name;
    best.mirror = mirror;
  }
  if (best.mirror) score_.fill(best);
  return best;
}

Result BentPlanes::with_pairs(const MethodImplementation& kind, const Mirror& plane,
                              const ParameterValues& values, const Context& context) const {
  Result result = best_of({&kind}, bend_of(plane));
  result.parameters = values.all();
  add_pairs(result, cloud_, values, context);
  return result;
}

PlaneBend BentPlanes::bend_of(const Mirror& plane) const {
  return refinement_.bend_of(in_frame(plane, cloud_.frame));
}

namespace {

// Of the rows from the sphere, or circle, that fits them. Flat ones fit a straight one better than
// any that this finds.
template <int n>
double distance_from_round(const Eigen::Matrix<double, Eigen::Dynamic, n>& rows) {
  const auto count = static_cast<double>(rows.rows());
  Eigen::Matrix<double, Eigen::Dynamic, n> unit = rows.rowwise() - rows.colwise().mean();
  const double size = std::sqrt(unit.squaredNorm() / count);
  if (!(size > 0)) return 0;
  unit /= size;
  const Eigen::Matrix<double, n, n> scatter = unit.transpose() * unit;
  const double flat = std::sqrt(std::max(0.0, eigen_of(scatter).values[0]) / count);
  const Eigen::VectorXd round = sphere_through(unit);
  const Eigen::VectorXd off =
      (unit.rowwise() - round.head<n>().transpose()).rowwise().norm().array() - round[n];
  return size * std::min(flat, std::sqrt(off.squaredNorm() / count));
}

Points centres_of(const FreeForm& mirror) {
  Points centres(static_cast<Index>(mirror.patches().size()), 3);
  for (Index i = 0; i < centres.rows(); ++i)
    centres.row(i) = mirror.patches()[i].centre.transpose();
  return centres;
}

}  // namespace

double distance_from_sphere(const FreeForm& mirror) {
  return distance_from_round<3>(centres_of(mirror));
}

double distance_from_cylinder(const FreeForm& mirror) {
  Matrix3 normals = Matrix3::Zero();
  for (const Patch& patch : mirror.patches())
    normals += patch.frame.row(2).transpose() * patch.frame.row(2);
  const Matrix3 axes = eigen_of(normals).vectors;
  return distance_from_round<2>(centres_of(mirror) * axes.rightCols<2>());
}

}  // namespace symsurf
