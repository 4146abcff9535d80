#pragma once

#include <algorithm>
#include <cmath>

#include "surfels.h"

namespace symsurf {

/// How well an image lands on its partner: its offset from the partner's tangent plane counts in
/// full, along the plane hardly, because partners are samples of a sheet.
struct Agreement {
  Matrix3 metric;  ///< squared residual = offset' metric offset
  double squared;  ///< that residual
  double gap;      ///< squared, in all directions alike
  double facing;   ///< 0..1: do the normals mirror each other?

  Agreement(const Vector3& offset, const Vector3& image_normal, double image_flatness,
            const Surfel& partner) {
    constexpr double along_sheet = 0.08, inside_blob = 0.4;
    const double flat = partner.flatness;
    metric = flat * partner.normal * partner.normal.transpose();
    metric.diagonal().array() += along_sheet * flat + inside_blob * (1 - flat);
    squared = offset.dot(metric * offset);
    gap = offset.squaredNorm();
    const double cosine = image_normal.dot(partner.normal);
    const double turned = image_flatness * flat * (1 - cosine * cosine);
    facing = (1 - turned) * (1 - turned);
  }

  /// 0..1. Where the gap is small in every direction, nobody asks for normals.
  double weight(double tolerance) const {
    const double scale = 1 / (2 * tolerance * tolerance);
    return std::max(facing * std::exp(-squared * scale), std::exp(-9 * gap * scale));
  }
};

/// 0 for points that the mirror hardly moves, whose symmetry is trivial, to 1.
inline double displaced(double distance, double tolerance) {
  return std::clamp(2 * std::abs(distance) / tolerance - 1, 0.0, 1.0);
}

}  // namespace symsurf
