#pragma once

#include <cmath>
#include <optional>
#include <vector>

#include "base/math.h"
#include "cloud/principal_frame.h"
#include "score/correspondence.h"
#include "spatial/nearest_points.h"

namespace symsurf {

/// Where the same points, or some of them, stand on both sides, the gaps between images and the
/// points nearest to them all but vanish at the true mirror, while by chance a tenth of all images
/// comes within a fifth of the spacing at best: converges on them to rounding. None where there are
/// no such points. The shape, the positions of the points that are looked at and the spacing are in
/// the principal frame.
template <typename Shape>
std::optional<Shape> fitted_to_exact_pairs(Shape shape, const std::vector<Vector3>& positions,
                                           const NearestPoints& points, const PrincipalFrame& frame,
                                           double spacing) {
  constexpr int steps = 16;
  constexpr double worth_trying = 0.12, exact = 0.01;  // of the spacing
  struct Gap {
    Vector3 position, vector;
  };
  double typical = 0;
  for (int step = 0; step < steps; ++step) {
    std::vector<Vector3> moved_points, images;
    for (const Vector3& x : positions) {
      // What lies on the mirror has itself for a partner.
      const Vector3 image = shape.reflect(x);
      if (!image.allFinite() || displaced(shape.distance(x), spacing) < 1) continue;
      moved_points.push_back(x);
      images.push_back(frame.from_frame(image));
    }
    const std::vector<Vector3> partners = points.nearest(images, spacing * frame.size);
    std::vector<Gap> gaps;
    std::vector<double> lengths;
    for (std::size_t i = 0; i < partners.size(); ++i) {
      if (!partners[i].allFinite()) continue;
      const Vector3& x = moved_points[i];
      gaps.push_back({x, shape.reflect(x) - frame.to_frame(partners[i])});
      lengths.push_back(gaps.back().vector.norm());
    }
    if (gaps.size() < 10) return std::nullopt;
    typical = quantile(std::move(lengths), 0.1);
    if (typical > worth_trying * spacing) return std::nullopt;
    typename Shape::Step sum(shape);
    for (const Gap& gap : gaps)
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
