#pragma once

#include <algorithm>
#include <cmath>

#include "cloud/surfels.h"

namespace symsurf {

/// What offsets count between an image and its partner: in any direction, and, on top, off the
/// surface.
struct Metric {
  double isotropic, off_surface;
  Vector3 normal;  ///< of the surface, unit

  operator Matrix3() const {
    Matrix3 m = off_surface * normal * normal.transpose();
    m.diagonal().array() += isotropic;
    return m;
  }
};

/// 1 to 0 as x grows from 0 to 16: close to exp(-x), at a fraction of its cost.
inline double fading(double x) {
  const double left = std::max(0.0, 1 - x / 16);
  const double squared = left * left, fourth = squared * squared, eighth = fourth * fourth;
  return eighth * eighth;
}

/// How well an image lands on its partner: its offset from the partner's tangent plane counts in
/// full, along the plane hardly, because partners are samples of a surface.
struct Correspondence {
  const Facet& partner;
  double isotropic;           ///< how much an offset in any direction counts
  double gap;                 ///< squared, in all directions alike
  double squared;             ///< squared residual = offset' metric offset
  double normal_consistency;  ///< 0..1: do the normals mirror each other?

  Correspondence(const Vector3& offset, const Vector3& image_normal, double image_flatness,
                 const Facet& partner)
      : partner(partner), gap(offset.squaredNorm()) {
    const double flat = partner.flatness, off_surface = offset.dot(partner.normal);
    isotropic = isotropic_share(flat, 0.08);
    squared = flat * off_surface * off_surface + isotropic * gap;
    const double cosine = image_normal.dot(partner.normal);
    const double turned = image_flatness * flat * (1 - cosine * cosine);
    normal_consistency = (1 - turned) * (1 - turned);
  }

  Metric metric() const { return {isotropic, partner.flatness, partner.normal}; }

  /// The same where an offset along a surface counts that much.
  Metric metric(double along_surface) const {
    return {isotropic_share(partner.flatness, along_surface), partner.flatness, partner.normal};
  }

  /// 0..1. Where the gap is small in every direction, nobody asks for normals.
  double weight(double tolerance) const {
    const double scale = 1 / (2 * tolerance * tolerance);
    return std::max(normal_consistency * fading(squared * scale), fading(9 * gap * scale));
  }

 private:
  static double isotropic_share(double flat, double along_surface) {
    constexpr double inside_blob = 0.4;
    return along_surface * flat + inside_blob * (1 - flat);
  }
};

/// How far an image is from the cloud's surface, `gap` from its partner. Along a surface, or inside
/// a volume, a partner is as near as the points' spacing allows: only what exceeds it counts.
inline double distance_past(const Vector3& gap, const Facet& partner, double spacing) {
  const auto squared = [](double x) { return x * x; };
  const double length = gap.norm(), off_surface = gap.dot(partner.normal);
  const double along = std::sqrt(std::max(0.0, squared(length) - squared(off_surface)));
  const double surface = squared(off_surface) + squared(0.3 * std::max(0.0, along - spacing));
  const double volume = squared(0.6 * std::max(0.0, length - spacing));
  const double flat = squared(partner.flatness), round = squared(1 - partner.flatness);
  return std::min(std::sqrt(flat * surface + round * volume), 3 * length);
}

/// A robust kernel with a negative lobe: 1 where an image lies on the cloud's surface, minus the
/// penalty where it is just off it, 0 far from it. A true mirror of a shape with a piece missing
/// sends images into the void, a wrong one sends them past the surface everywhere.
struct NearMissKernel {
  double inlier, near_miss;  ///< distances from the surface, over the cloud's size
  double penalty;            ///< what a near miss counts

  /// `normal_consistency`, 0..1: do the normals mirror each other?
  double operator()(double residual, double normal_consistency) const {
    const double near = residual / inlier, past = residual / near_miss;
    return normal_consistency / (1 + near * near) -
           penalty * past * past * std::exp(1 - past * past);
  }
};

/// 0 for points that the mirror hardly moves, whose symmetry is trivial, to 1.
inline double displaced(double distance, double tolerance) {
  return std::clamp(2 * std::abs(distance) / tolerance - 1, 0.0, 1.0);
}

/// 0..1. Past a rim images find their partners on it, whose tangent plane says nothing there;
/// inside a surface the nearest point is hardly further along it than half the spacing.
inline double inside_surface(const Vector3& gap, const Facet& partner, double spacing) {
  const double off = gap.dot(partner.normal);
  const double along = std::sqrt(std::max(0.0, gap.squaredNorm() - off * off));
  const double past = 3 * partner.flatness * std::max(0.0, along / spacing - 0.5);
  return fading(past * past / 2);
}

}  // namespace symsurf
