#pragma once

#include <symsurf/context.h>
#include <symsurf/detect.h>
#include <symsurf/mirror.h>
#include <symsurf/points.h>

#include <cmath>
#include <string_view>

#include "cloud/closest_point_on_mesh.h"
#include "cloud/cloud.h"
#include "cloud/point_tree.h"

namespace symsurf {

/// A mirror is found where it maps half of what it moves onto the shape, and chance does not.
inline constexpr double usual_minimum_score = 0.5;

/// The evidence of MirrorScore from which on a mirror is found. Of 40 shapes without a mirror
/// planes had at most 0.55 but for tetrahedra and tetracubes. Spheres and cylinders of chance hide
/// what contradicts them where the shape has nothing: they had at most 0.68, with 0.1 to 0.2
/// missing. Right ones have more than that by 0.04 at least, or as much as 0.6 where little is
/// missing.
inline double least_evidence(const Mirror& mirror, double missing_share) {
  const std::string_view kind = mirror.kind();
  if (kind == "sphere" || kind == "cylinder") return 0.58 + 0.8 * missing_share;
  return kind == "plane" ? 0.56 : 0.6;
}

/// One of the statistics that a score fills in.
inline double statistic(const Result& result, const char* name, double otherwise = 0) {
  const auto found = result.statistics.find(name);
  return found == result.statistics.end() ? otherwise : std::get<double>(found->second);
}

/// Sets "verdict" and "reason" of a mirror, or of pairs alone. A reason that the method gave says
/// why it chose this mirror: where there is none, what is missing comes before it.
inline void judge(Result& result, const Mirror* mirror, double minimum_score) {
  const bool has_mirror = mirror || result.pairs.rows() > 0;
  // Rounded down: a score below the minimum does not read as the minimum.
  const auto digits = [](double x) { return to_string(Value(std::floor(1e4 * x) / 1e4)); };
  const double sure = statistic(result, "evidence", 1);
  const bool scores = has_mirror && result.score >= minimum_score;
  const double least = mirror ? least_evidence(*mirror, statistic(result, "missing_share")) : 0;
  const bool found = scores && sure >= least;
  result.statistics["verdict"] = std::string(found ? "found" : "none");
  std::string score = result.method + " finds no mirror";
  if (has_mirror)
    score = result.method + " scores " + digits(result.score) +
            (scores ? ", at least " : ", below ") + "the minimum_score of " +
            to_string(Value(minimum_score));
  constexpr double too_few = 0.1;  // of the samples, that tell a mirror from others
  if (scores && !found)
    score += statistic(result, "deciding_share", 1) < too_few
                 ? ", but it cannot be decided at this sampling"
                 : ", but its evidence is " + digits(sure) + ", below " + digits(least) +
                       ": mirrors beside it map the shape nearly as well";
  const auto [reason, is_new] = result.statistics.try_emplace("reason", score);
  if (!is_new && !found) reason->second = score + "; " + std::get<std::string>(reason->second);
}

/// Whether mirrors map a mesh onto itself: vertices onto vertices, to rounding, and the surface
/// nearly, as faces may divide its two sides along different diagonals.
class MeshSymmetry {
 public:
  /// The mesh, its vertices the points, must outlive this.
  MeshSymmetry(const Cloud& mesh, const Context& context);

  /// `samples`: of the surface.
  bool operator()(const Mirror& mirror, PointsView samples) const;

 private:
  const Cloud& mesh_;
  const PointTree& tree_;
  ClosestPointOnMesh surface_;
};

}  // namespace symsurf
