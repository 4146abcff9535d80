#pragma once

#include <symsurf/context.h>
#include <symsurf/detect.h>
#include <symsurf/mirror.h>

#include <Eigen/Geometry>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "cloud/cloud.h"
#include "cloud/point_tree.h"
#include "cloud/surfels.h"
#include "score/cloud_halves.h"
#include "score/verdict.h"

namespace symsurf {

class MirrorLayers;
class MirrorSides;

/// How well a mirror maps a cloud onto itself.
struct MirrorFit {
  double share = 0;    ///< of the points that the mirror moves; sampling may take it past 1
  double covered = 0;  ///< share of those that have anything of the cloud where their image is
  double exact = 0;    ///< share of those whose image is a point of the cloud, to rounding
  double deviation =
      0;  ///< median of PointFit::deviation where the shape has the image, input units
  double evidence = 0;  ///< of a mirror of any shape, that it is none of chance's, in nats
};

/// What a map does with one of the points that the score is measured at.
struct PointFit {
  std::size_t point = 0;  ///< which of them
  double weight = 0;      ///< what it counts: its ceiling, less where the map hardly moves it
  double support = 0;     ///< so much of that for the map; may be negative
  double missing = 0;     ///< so much of that is lost as the cloud has less where its image falls
  double rim = 0;         ///< so much of that is lost as the cloud has less around the point itself
  bool exact = false;     ///< its image is a point of the cloud, to rounding
  double deviation = 0;   ///< of its image from the shape, across the surface, in diagonals
};

/// The score of all kinds of mirror: the share of the cloud that the mirror maps onto it as well as
/// the cloud maps onto itself.
///
/// The cloud is split at random into halves A and B. At points spread evenly over the cloud s is
/// how well the image of B says what A says (BallSupport), and c, the ceiling, how well B itself
/// does: the score is the sum of s over that of c. What the sampling, the noise and the distance of
/// layers leave unsaid is so in both. A point whose image is a point of the cloud counts 1 in both,
/// as all do of a mesh that the mirror maps onto itself.
class MirrorScore {
 public:
  /// The cloud must outlive the score, and keep its tree.
  MirrorScore(const Cloud& cloud, const Context& context);

  MirrorFit fit(const Mirror& mirror) const { return fit(mirror, 1); }
  /// The share that a plane maps of what tells it from the planes beside it. A sheet slides over
  /// itself, and any plane upright to it maps most of it: each point counts by how much less of it
  /// the plane maps when turned or shifted.
  double distinctive_share(const Mirror& plane) const;
  /// The same of a third of the points: enough to see which mirrors are worth refining.
  MirrorFit glance(const Mirror& mirror) const { return fit(mirror, 3); }
  /// Of a rotation, a reflection or both, in the principal frame, what each point that it moves
  /// says; of every `stride`-th.
  std::vector<PointFit> point_fits(const Eigen::Isometry3d& map, std::size_t stride = 1) const;

  /// Sets the result's score, and among its statistics "explained_share", "exact_share",
  /// "covered_share", "deviation" and, of a plane that may be one of chance, "distinctive_share".
  void fill(Result& result) const { fill(*result.mirror, result); }
  /// The same of a mirror that is not the result's own.
  void fill(const Mirror& mirror, Result& result) const { fill(mirror, fit(mirror), result); }
  /// The same of a mirror whose fit() is known.
  void fill(const Mirror& mirror, const MirrorFit& fit, Result& result) const;

  /// The result with the best of at least one mirror, the others its candidates, best first.
  Result ranked(const std::string& method,
                const std::vector<std::shared_ptr<Mirror>>& mirrors) const;

 private:
  struct Sample {
    Vector3 position;
    std::size_t split;  // whose halves it is compared in
    Ball ball;          // of one half
    double ceiling;     // support of the other half for it
  };

  MirrorFit fit(const Mirror& mirror, std::size_t stride) const;
  // image(x) in input units; image_ball(sample), of the other half's image, in the principal frame.
  template <typename Image, typename ImageBall>
  std::vector<PointFit> point_fits(const Image& image, const ImageBall& image_ball,
                                   std::size_t stride, MirrorLayers* layers,
                                   MirrorSides* sides) const;
  static void add_sides(const Sample& sample, const Ball& image, const Vector3& to_image,
                        MirrorSides& sides);
  MirrorFit whole_of(const std::vector<PointFit>& points, std::size_t stride) const;
  double radius_for(const CloudHalves& halves) const;
  double measured_noise() const;
  ThinnedHalf mirrored(const ThinnedHalf& half, const Mirror& mirror) const;

  const Cloud& cloud_;
  NearestPoints points_;
  Tolerance tolerance_;
  const Surfels& coarse_;
  std::vector<CloudHalves> splits_;
  double radius_;     // of the balls
  double noise_ = 0;  // standard deviation, in diagonals
  double moved_;      // displacement from which on a point counts in full
  std::optional<MeshSymmetry> mesh_;
  std::vector<Sample> samples_;
};

/// The score: the share that a mirror maps, the less the freer its kind, and of one of any shape
/// times the probability that it is none of chance's.
double score_of(const MirrorFit& fit, std::string_view kind);

/// The order of mirrors: as the score without that probability, which says how sure a mirror is
/// and not how well it fits; those over which all partners are exact first.
double merit(const MirrorFit& fit, std::string_view kind);

/// One of the statistics that a score fills in; 0 where it has none of that name.
double statistic(const Result& result, const char* name);

/// Whether every point that the result's mirror moves has an exact partner: no mirror is better.
bool is_exact(const Result& result);

/// Of a mirror that others fit no better, none is surer: lowers the scores of its candidates.
void cap_candidates(Result& result);

}  // namespace symsurf
