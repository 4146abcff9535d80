#pragma once

#include <symsurf/detect.h>

#include "expect.h"

namespace symsurf {

inline bool is_finite(const Value& value) {
  if (const auto* real = std::get_if<double>(&value)) return std::isfinite(*real);
  if (const auto* three = std::get_if<Vector3>(&value)) return three->allFinite();
  if (const auto* table = std::get_if<Eigen::MatrixXd>(&value)) return table->allFinite();
  return true;
}

inline void expect_finite(const Mirror& mirror) {
  for (const auto& [name, value] : mirror.numbers())
    expect(is_finite(value), "a mirror's numbers are finite");
}

/// What holds of every result for so many points.
inline void expect_sound(const Result& result, Index points) {
  expect(result.score >= 0 && result.score <= 1, "a score is in [0, 1]");
  expect(result.verdict() == "found" || result.verdict() == "none", "there is a verdict");
  expect(!result.reason().empty(), "a verdict has a reason");
  expect(result.residuals.size() == result.pairs.rows(), "a pair has a residual");
  expect(result.residuals.allFinite(), "residuals are finite");
  expect(result.surface_points.allFinite(), "surface points are finite");
  for (const Index index : result.pairs.reshaped())
    expect(index >= 0 && index < points, "pairs are of points");
  if (result.mirror) {
    expect_finite(*result.mirror);
    runs([&] {
      expect(result.mirror->mesh(4).vertices.allFinite(), "a mirror's triangles are finite");
    });
  }
  for (const Result& candidate : result.candidates) {
    expect(candidate.score >= 0 && candidate.score <= result.score, "candidates score no more");
    if (candidate.mirror) expect_finite(*candidate.mirror);
  }
}

}  // namespace symsurf
