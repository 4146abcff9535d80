#pragma once

#include <Eigen/Geometry>
#include <array>
#include <complex>
#include <optional>
#include <vector>

#include "cloud/surface_points.h"
#include "thinned_surface.h"

namespace symsurf {

/// Fits maps to a thinned surface: iterative closest points with point-to-plane residuals (Chen and
/// Medioni 1992). The surface must outlive it.
class SurfaceFit {
 public:
  SurfaceFit(const ThinnedSurface& surface, bool scales) : surface_(surface), scales_(scales) {}

  const ThinnedSurface& surface() const { return surface_; }

  /// Where a map takes a point of the surface.
  struct Landing {
    Index partner = -1;  ///< nearest to the image; -1: none near
    double off = 0;      ///< the image from the partner's plane, diagonals
    bool agrees = false;
  };
  Landing landing(const Eigen::Affine3d& map, Index i, double tolerance) const;

  /// The share of these points whose images agree.
  double share(const Eigen::Affine3d& map, const std::vector<Index>& points,
               double tolerance) const;

  /// The map after some Gauss-Newton steps on these points.
  Eigen::Affine3d fitted(const Eigen::Affine3d& start, const std::vector<Index>& points,
                         double tolerance, int steps) const;

  /// The share of these points that come off the surface whichever way their images slide: next to
  /// none of planes, balls, edges and bars, which slide on themselves. The most of so many slides,
  /// each twice as long as the one before.
  double hold(const Eigen::Affine3d& map, const std::vector<Index>& points, double tolerance,
              int slides) const;

  /// A translation or reflection in place of a motion or glide that fits these points no better.
  Eigen::Affine3d simplest(const Eigen::Affine3d& map, const std::vector<Index>& points,
                           double tolerance) const;

 private:
  // The motion of the images that the surface resists least, by a few tolerances.
  Eigen::Affine3d loosest(const Eigen::Affine3d& map, const std::vector<Index>& points,
                          double tolerance) const;
  double mean_square(const Eigen::Affine3d& map, const std::vector<Index>& points,
                     double tolerance) const;

  const ThinnedSurface& surface_;
  bool scales_;
};

/// A connected patch of a thinned surface and where a map takes it.
struct PatchPair {
  Eigen::Affine3d map = Eigen::Affine3d::Identity();
  std::vector<Index> from, onto;  ///< points of the patch, ascending; the nearest to their images
  double score = 0;  ///< 0..1: how close images come to the surface, of how close its points do
  double hold = 0;   ///< as SurfaceFit::hold, or the evidence of a pair of components
};

/// Grows the patch on which a map holds (Mitra et al. 2006), and fits the map to it.
class PatchGrowth {
 public:
  explicit PatchGrowth(const SurfaceFit& fit);

  /// From some points that the map takes about to the surface; nothing where the map does not hold
  /// on most of them, or on fewer than `least` points after growing.
  std::optional<PatchPair> grown(const Eigen::Affine3d& map, const std::vector<Index>& seeds,
                                 Index least, const Context& context) const;

 private:
  std::vector<Index> agreeing(const Eigen::Affine3d& map, const std::vector<Index>& seeds) const;
  void score(PatchPair& pair) const;

  const SurfaceFit& fit_;
  double tolerance_;
  std::vector<double> ceilings_;  // how close each point comes to the surface of the others
};

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

struct PartialSearchOptions {
  VoteOptions votes;
  double minimum_size = 0;   // of a patch: share of the surface
  double minimum_score = 0;  // of a patch
  Index count = 0;           // most that are found
};

/// Where whole components of at least so many points are laid onto others like them: discs of
/// smooth ones say too little for votes.
std::vector<PatchPair> component_pairs(const ThinnedSurface& surface,
                                       const PartialSearchOptions& options, Index least,
                                       const Context& context);

/// The partial symmetries of a surface (Mitra et al. 2006): patches that a map takes to other
/// places of the surface. The largest that fit well first.
std::vector<PatchPair> partial_patches(const ThinnedSurface& surface,
                                       const PartialSearchOptions& options, const Context& context);

}  // namespace symsurf
