#pragma once

#include <symsurf/mirror.h>
#include <symsurf/value.h>

#include <memory>
#include <string>
#include <vector>

namespace symsurf {

/// What a method found. No symmetry is a result too: one with a low score.
struct Result {
  std::string method;
  std::shared_ptr<Mirror> mirror;  ///< null: none found, or surface points only
  /// Midpoints of the pairs, at most half a residual off the mirror; perpendicular, quadric and
  /// fixed_direction project them onto it. Input units.
  Points surface_points;
  Pairs pairs;                ///< (point, partner), indices into the input
  Eigen::VectorXd residuals;  ///< distance from the image to the partner, input units
  /// 0: no symmetry; 1: as good as the sampling shows. The share of the shape that the mirror maps
  /// onto it as well as one half of the points, drawn at random, says what the other half does.
  /// What lacks to 1 has no counterpart, 1 - "covered_share" of the statistics, or differs from it;
  /// of quadrics, height fields and free forms what chance maps lacks, too.
  double score = 0;
  /// Other mirrors, without pairs, by score; none scores more than the result.
  std::vector<Result> candidates;
  Values parameters;  ///< as used
  /// "verdict", "found" or "none"; "reason", a sentence that says why; "covered_share": of the
  /// points that the mirror moves, those with anything of the shape at their image; "deviation":
  /// how far images lie off the shape, across its surface, in the median over what the mirror maps,
  /// less what the sampling leaves open, input units; of planes that score less than 0.9
  /// "distinctive_share", which has to be the minimum_score, too: what they map of what tells them
  /// from the planes beside them; whatever else the method reports; and, where there are some, how
  /// many "nonfinite_points" were left out as not finite and how many "outliers" as lying far off:
  /// they have no partners. "surface_samples": how many points were sampled on the faces.
  /// "boundary_points" of a volumetric cloud, where the mirror and the score are those of its
  /// boundary: how many it has. "warning": a sentence for the caller, where the method is not for
  /// such a cloud.
  Values statistics;
  double seconds = 0;

  /// "found" where there is a mirror whose score is at least `minimum_score`, else "none".
  const std::string& verdict() const { return std::get<std::string>(statistics.at("verdict")); }
  /// Why, in a sentence.
  const std::string& reason() const { return std::get<std::string>(statistics.at("reason")); }
};

}  // namespace symsurf
