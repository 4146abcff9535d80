#pragma once

#include <Eigen/Geometry>
#include <array>
#include <complex>
#include <optional>
#include <vector>

#include "cloud/surface_points.h"
#include "thinned_surface.h"

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
  /// The same surface seen from its other side.
  HeightSignature from_behind() const;
};

/// Describes a surface about its points by what is connected with them within a radius and does not
/// face away: of a thin bar the side that a point is on.
class SurfaceDiscs {
 public:
  SurfaceDiscs(const SurfacePoints& surface, double radius);

  /// Seen from the side on which the disc is a bowl; none where it holds few points.
  std::optional<HeightSignature> about(Index i) const;

 private:
  struct Oriented {
    Index point;
    Vector3 normal;
  };
  std::vector<Oriented> connected(Index i) const;

  const SurfacePoints& surface_;
  double radius_;
};

/// A turn of one disc that lays it on another, reflected or not.
struct DiscMatch {
  double angle = 0;
  double residual = 0;  ///< of what is left, to the mean length of the two signatures
};

/// The turns that fit better than those next to them, the best first: a corner has three, the end
/// of a square bar four.
std::vector<DiscMatch> matches(const HeightSignature& from, const HeightSignature& onto,
                               bool reflected);

/// The similarity that lays one disc on the other.
Eigen::Affine3d laid_onto(const HeightSignature& from, const HeightSignature& onto, bool reflected,
                          double angle);

/// A pair of like points and the map between them: mass in the space of transformations.
struct TransformationVote {
  Index from = -1, onto = -1;
  Eigen::Affine3d map = Eigen::Affine3d::Identity();
  double weight = 0;
};

struct VoteOptions {
  bool reflections = true, motions = true, scales = false;
  double radius = 0;  ///< of the discs, diagonals
};

/// Both ways of every pair of points that are among the most alike of the surface.
std::vector<TransformationVote> transformation_votes(const ThinnedSurface& surface,
                                                     const VoteOptions& options,
                                                     const Context& context);

/// Votes around one in whose neighbourhood they are densest.
struct VoteCluster {
  Eigen::Affine3d map = Eigen::Affine3d::Identity();  ///< of that one
  std::vector<Index> votes;
};

/// Where votes are densest in the space of turns, shifts and scales (Mitra et al. 2006), of
/// reflections and of motions, the densest first.
std::vector<VoteCluster> vote_clusters(const std::vector<TransformationVote>& votes,
                                       std::size_t most, const Context& context);

}  // namespace symsurf
