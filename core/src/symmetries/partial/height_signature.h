#pragma once

#include <Eigen/Geometry>
#include <array>
#include <complex>
#include <optional>
#include <vector>

#include "cloud/surface_points.h"

namespace symsurf {

/// The surface about a point as a height over its tangent disc, in Zernike polynomials up to the
/// fourth degree (Maximo et al. 2011): the second degree are the principal curvatures of Mitra et
/// al. (2006), the others distinguish what these do not. Moduli do not change as the disc is turned
/// or reflected, phases give the turn.
struct HeightSignature {
  static constexpr int length = 8, turning = 5;
  /// The order in which each of `waves` repeats around the disc.
  static constexpr std::array<int, turning> orders{1, 2, 2, 3, 4};

  Vector3 origin = Vector3::Zero();     ///< on the fitted surface
  Matrix3 frame = Matrix3::Identity();  ///< columns: two tangents and the normal, right-handed
  double radius = 0;                    ///< of the disc, to which heights are relative
  std::array<double, 2> even{};         ///< of the terms that no turn changes
  std::array<std::complex<double>, turning> waves{};

  Eigen::Vector<double, length> invariants() const;
  /// The length of all that a turn changes.
  double waviness() const;
  /// The same surface seen from its other side.
  HeightSignature from_behind() const;
};

/// Describes a surface about points by those of it within a radius. Where discs hold more than some
/// hundred on average, as they do if they are large or if surfaces cross, of every so many.
class DiscSamples {
 public:
  DiscSamples(const SurfacePoints& surface, double radius, const Context& context);

  /// Seen from the side on which the disc is a bowl; none where it holds few points.
  std::optional<HeightSignature> about(const Vector3& x) const;

  Index size() const { return points_.rows(); }

 private:
  static Points thinned(const SurfacePoints& surface, double radius);
  Vector3 point(Index i) const { return points_.row(i).transpose(); }

  double radius_;
  Points points_;
  PointTree tree_;
};

/// A turn of one disc that lays it on another, reflected or not.
struct DiscMatch {
  double angle = 0;
  double residual = 0;  ///< of what is left, to the mean length of the two signatures
};

/// The best turn.
std::optional<DiscMatch> best_match(const HeightSignature& from, const HeightSignature& onto,
                                    bool reflected);

/// The similarity that lays one disc on the other.
Eigen::Affine3d laid_onto(const HeightSignature& from, const HeightSignature& onto, bool reflected,
                          double angle);

}  // namespace symsurf
