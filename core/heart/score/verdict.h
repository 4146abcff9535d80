#pragma once

#include <symsurf/context.h>
#include <symsurf/detect.h>
#include <symsurf/mirror.h>
#include <symsurf/points.h>

#include <cmath>

#include "cloud/closest_point_on_mesh.h"
#include "cloud/cloud.h"
#include "cloud/point_tree.h"

namespace symsurf {

/// A mirror is found where it maps half of what it moves onto the shape. Of 100 random bodies and
/// surfaces without one, clean and noisy, the best plane scores 0.43 at most but for one, 0.57
/// (docs/methods/plane.md).
inline constexpr double usual_minimum_score = 0.5;

/// Sets "verdict" and "reason": a mirror is found where its score, and that of what tells it from
/// the mirrors beside it ("distinctive_share"), are at least the minimum. A reason that the method
/// gave says why it chose this mirror: where there is none, what is missing comes before it.
inline void judge(Result& result, bool has_mirror, double minimum_score) {
  // Rounded down: a score below the minimum does not read as the minimum.
  const auto digits = [](double x) { return to_string(Value(std::floor(1e4 * x) / 1e4)); };
  const auto distinctive = result.statistics.find("distinctive_share");
  const double told =
      distinctive == result.statistics.end() ? result.score : std::get<double>(distinctive->second);
  const bool scores = has_mirror && result.score >= minimum_score;
  const bool found = scores && told >= minimum_score;
  result.statistics["verdict"] = std::string(found ? "found" : "none");
  std::string score = result.method + " finds no mirror";
  if (has_mirror)
    score = result.method + " scores " + digits(result.score) +
            (scores ? ", at least " : ", below ") + "the minimum_score of " +
            to_string(Value(minimum_score));
  if (scores && !found)
    score += ", but " + digits(told) +
             " where the shape does not slide over itself: planes beside it map it nearly as well";
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
