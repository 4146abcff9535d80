#pragma once

#include <symsurf/context.h>
#include <symsurf/detect.h>
#include <symsurf/mirror.h>

#include <Eigen/Geometry>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "cloud/cloud.h"
#include "score/sampled_surface.h"
#include "score/verdict.h"

namespace symsurf {

class MirrorSides;

/// Diagonals from the mirror, from which on a sample counts in full.
inline constexpr double fully_moved = 0.02;

/// How well a mirror maps a cloud onto itself. Shares are of the samples that it moves.
struct MirrorFit {
  double share = 0;      ///< that it maps onto the surface, over what the identity does
  double missing = 0;    ///< whose images fall where the cloud has nothing
  double exact = 0;      ///< whose images are points of the cloud, to rounding
  double deviation = 0;  ///< median distance of mapped images from the surface, input units
  double log_odds = 0;   ///< of a mirror of any shape, that chance did not make it, in nats
};

/// What a map does with one of the samples.
struct PointFit {
  Index point = 0;     ///< which of them
  double weight = 0;   ///< what it counts: its ceiling, less where the map hardly moves it
  double support = 0;  ///< so much of that for the map
  double missing = 0;  ///< so much is lost as the cloud has less where its image falls
  double rim = 0;      ///< so much is lost as the cloud has less around the sample itself
  bool exact = false;  ///< its image is a point of the cloud, to rounding
  Vector3 image = Vector3::Constant(NAN);  ///< in the principal frame
  bool has_partner = false;                ///< the image lies next to the surface
  double residual = 0;                     ///< of the image from the surface, in diagonals, signed
  Vector3 normal = Vector3::Zero();        ///< of the surface there

  /// 0..1.
  double mapped() const { return weight > 0 ? std::min(1.0, support / weight) : 1; }
};

/// The score of all kinds of mirror: the share of the cloud that the mirror maps onto it, at the
/// scale of its sampling.
///
/// The image of each sample (SampledSurface) has a support s by its distance from the plane through
/// the cloud's points near it. c, the ceiling, is that of the sample itself, by the same estimator:
/// the share is the sum of s over that of c, each weighted by how far the mirror moves the sample.
/// What sampling and noise leave unsaid is so in both. A sample whose image is a point of the cloud
/// counts 1 in both, as all do of a mesh that the mirror maps onto itself.
class MirrorScore {
 public:
  /// The cloud must outlive the score, and keep its tree. Its loops use the context's threads.
  MirrorScore(const Cloud& cloud, const Context& context);

  /// Of every `stride`-th sample: a third are enough to rank mirrors, a ninth while they are rough.
  MirrorFit fit(const Mirror& mirror, Index stride = 1) const;
  /// Of a rotation, a reflection or both, in the principal frame, what each sample that it moves
  /// says; of every `stride`-th.
  std::vector<PointFit> point_fits(const Eigen::Isometry3d& map, Index stride = 1) const;

  /// How well a map lays the cloud on another: it maps one principal frame to the other, both of
  /// one size, and moves every sample.
  MirrorFit fit(const Eigen::Isometry3d& map, const MirrorScore& onto, Index stride = 1) const;
  /// Whether it does so better than the same one turned and shifted, 0..1.
  double evidence(const Eigen::Isometry3d& map, const MirrorScore& onto) const;

  /// The nats that speak for one mirror against another, by the residuals of the samples: those of
  /// a mirror are Student's of 3 degrees, as wide as the noise and the body's own asymmetry, but
  /// for a share without a partner, both at their likeliest; samples count as independent as the
  /// residuals' sums over windows of the mirror say (Schwarz 1978). `freedom`: numbers more.
  double nats(const Mirror& freer, const Mirror& simpler, double freedom) const;

  /// Sets the result's score, and among its statistics "mapped_share", "missing_share",
  /// "contradicted_share", "exact_share", "deviation", "evidence", "deciding_share", "angle_sd" and
  /// "offset_sd".
  void fill(Result& result) const { fill(*result.mirror, result); }
  /// The same of a mirror that is not the result's own.
  void fill(const Mirror& mirror, Result& result) const;

  /// The result with the best of at least one mirror, the others its candidates, best first.
  Result ranked(const std::string& method,
                const std::vector<std::shared_ptr<Mirror>>& mirrors) const;

 private:
  // `onto`: of this cloud or another.
  template <typename Image>
  std::vector<PointFit> point_fits(const Image& image_of, Index stride, const SampledSurface& onto,
                                   MirrorSides* sides = nullptr) const;
  MirrorFit whole_of(const std::vector<PointFit>& points, Index stride) const;
  template <typename Take>
  void with_image_of(const Mirror& mirror, const Take& take) const;
  template <typename Take>
  void with_fit_of(const Mirror& mirror, Index stride, const Take& take) const;
  // Whether a map maps the shape better than the same one moved, 0..1: the mean of two. What it
  // maps of the samples that tell it from those, over that and what contradicts it; and how far its
  // share lies between the greatest of theirs and 1. `deciding`: the samples that tell, over all.
  // `unmapped`: of the samples of `onto`, by the map back.
  struct Evidence {
    double sure = 0, deciding = 1;
  };
  using Motions = std::vector<std::vector<Eigen::Isometry3d>>;
  template <typename Image>
  Evidence evidence(const Image& image, const std::vector<PointFit>& fits, const Motions& motions,
                    const SampledSurface& onto, const std::vector<double>& unmapped_there) const;
  std::vector<double> unmapped(const std::vector<PointFit>& fits) const;
  void add_sides(const PointFit& fit, Index partner, MirrorSides& sides) const;

  const Cloud& cloud_;
  Context context_;
  SampledSurface surface_;
  std::optional<MeshSymmetry> mesh_;
};

/// The score: the share that a mirror maps, and of one of any shape times the probability that
/// chance did not make it.
double score_of(const MirrorFit& fit, std::string_view kind);

/// Whether every point that the result's mirror moves has an exact partner: no mirror is better.
bool is_exact(const Result& result);

}  // namespace symsurf
