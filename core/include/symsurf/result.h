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
  std::shared_ptr<Mirror> mirror;  ///< null for methods that find surface points only
  Points surface_points;           ///< midpoints of the pairs, in input units
  Pairs pairs;                     ///< (point, partner), indices into the input
  Eigen::VectorXd residuals;       ///< distance from the image to the partner, input units
  double score = 0;                ///< 0: no symmetry, 1: exact
  std::vector<Result> candidates;  ///< other mirrors, best first; without pairs
  Values parameters;               ///< as used
  Values statistics;               ///< whatever the method reports
  double seconds = 0;
};

}  // namespace symsurf
