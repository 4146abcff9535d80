#pragma once

#include <algorithm>
#include <cmath>

#include "cloud/surfel_map.h"
#include "cloud/surfels.h"
#include "score/correspondence.h"

namespace symsurf {

/// Share of the surfels whose images agree with the cloud, less `contradiction` times those whose
/// images come beside it, out of those the mirror moves (at least 35 % of all, so that a mirror the
/// cloud lies along explains nothing).
template <typename Shape>
double agreeing_share(const Surfels& surfels, const SurfelMap& map, const Shape& shape,
                      double tolerance, Index stride, double contradiction) {
  constexpr double least_moved = 0.35;
  double moved = 0, support = 0;
  Index looked = 0;
  for (Index i = 0; i < surfels.size(); i += stride, ++looked) {
    const Surfel& s = surfels[i];
    const double weight = displaced(shape.distance(s.position), tolerance);
    if (weight <= 0) continue;
    moved += weight;
    const Vector3 image = shape.reflect(s.position);
    const Index j = map.nearest(image);
    if (j < 0) continue;
    const Correspondence correspondence(image - surfels[j].position,
                                        shape.reflect_direction(s.position, s.normal), s.flatness,
                                        surfels[j]);
    const double agrees = correspondence.weight(tolerance);
    support += weight * (agrees - contradiction * (1 - agrees));
  }
  return support / std::max(moved, least_moved * static_cast<double>(looked));
}

/// The mirror moved onto the surfels' images, looking less far with each step. For a `Shape` see
/// candidate.h; `stride` k looks at every k-th surfel.
template <typename Shape>
Shape icp_steps(const Surfels& surfels, const SurfelMap& map, Shape shape, double widest,
                double narrowest, int steps, Index stride) {
  for (int step = 0; step < steps; ++step) {
    const double tolerance = widest * std::pow(narrowest / widest, step / (steps - 1.0));
    typename Shape::Step sum(shape);
    for (Index i = 0; i < surfels.size(); i += stride) {
      const Surfel& s = surfels[i];
      const double weight = displaced(shape.distance(s.position), tolerance);
      if (weight <= 0) continue;
      const Vector3 image = shape.reflect(s.position);
      const Index j = map.nearest(image);
      if (j < 0) continue;
      const Vector3 gap = image - surfels[j].position;
      const Correspondence correspondence(gap, shape.reflect_direction(s.position, s.normal),
                                          s.flatness, surfels[j]);
      sum.add(s.position, gap, correspondence.metric(), weight * correspondence.weight(tolerance));
    }
    shape = sum.taken();
  }
  return shape;
}

}  // namespace symsurf
