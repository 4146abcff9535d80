#pragma once

#include <cmath>
#include <optional>
#include <vector>

#include "base/math.h"
#include "score/correspondence.h"

namespace symsurf {

/// A position of the cloud, and its image less the point nearest to that.
struct Gap {
  Vector3 position, vector;
};

/// Where the same points, or some of them, stand on both sides, their gaps all but vanish at the
/// true mirror, while by chance a tenth of all images comes within a fifth of the spacing at best:
/// converges on them to rounding. None where there are no such points. gaps(shape, step) are those
/// no longer than `spacing`.
template <typename Shape, typename Gaps>
std::optional<Shape> fitted_to_exact_pairs(Shape shape, double spacing, const Gaps& gaps) {
  constexpr int steps = 16;
  constexpr double worth_trying = 0.12, exact = 0.01;  // of the spacing
  double typical = 0;
  for (int step = 0; step < steps; ++step) {
    std::vector<Gap> found = gaps(shape, step);
    // What lies on the mirror has itself for a partner.
    std::erase_if(found, [&](const Gap& gap) {
      return displaced(shape.distance(gap.position), spacing) < 1;
    });
    if (found.size() < 10) return std::nullopt;
    std::vector<double> lengths;
    for (const Gap& gap : found) lengths.push_back(gap.vector.norm());
    typical = quantile(std::move(lengths), 0.1);
    if (typical > worth_trying * spacing) return std::nullopt;
    typename Shape::Step sum(shape);
    for (const Gap& gap : found)
      if (gap.vector.norm() <= 3 * typical)
        sum.add(gap.position, gap.vector, Metric{1, 0, Vector3::Zero()}, 1);
    double moved;
    shape = sum.taken(&moved);
    if (moved < 1e-15) break;
  }
  if (typical >= exact * spacing) return std::nullopt;
  return shape;
}

}  // namespace symsurf
