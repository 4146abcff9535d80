#pragma once

#include <symsurf/result.h>

#include <cmath>

namespace symsurf {

/// A mirror is found where it maps half of what it moves onto the shape. Of 100 random bodies and
/// surfaces without one, clean and noisy, the best plane scores 0.43 at most but for one, 0.57
/// (docs/methods/plane.md).
inline constexpr double usual_minimum_score = 0.5;

/// Sets "verdict" and "reason". A reason that the method gave says why it chose this mirror: where
/// there is none, the score that is missing comes before it.
inline void judge(Result& result, bool has_mirror, double minimum_score) {
  // Rounded down: a score below the minimum does not read as the minimum.
  const double digits = std::floor(1e4 * result.score) / 1e4;
  const bool found = has_mirror && result.score >= minimum_score;
  result.statistics["verdict"] = std::string(found ? "found" : "none");
  const std::string score = has_mirror
                                ? result.method + " scores " + to_string(Value(digits)) +
                                      (found ? ", at least " : ", below ") +
                                      "the minimum_score of " + to_string(Value(minimum_score))
                                : result.method + " finds no mirror";
  const auto [reason, is_new] = result.statistics.try_emplace("reason", score);
  if (!is_new && !found) reason->second = score + "; " + std::get<std::string>(reason->second);
}

}  // namespace symsurf
