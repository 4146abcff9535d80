#pragma once

#include <symsurf/context.h>
#include <symsurf/mirror.h>
#include <symsurf/result.h>

#include <Eigen/Geometry>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "cloud/cloud.h"
#include "cloud/surfels.h"
#include "spatial/nearest_points.h"
#include "spatial/point_tree.h"

namespace symsurf {

class MirrorLayers;
class MirrorSides;

/// How well a mirror maps a cloud onto itself.
struct MirrorFit {
  double share = 0;         ///< mean support of the points that the mirror moves, at most 1
  double exact = 0;         ///< share of those whose image is a point of the cloud, to rounding
  double single_layer = 0;  ///< of a mirror of any shape, how far any such cloud has one
  double evidence = 0;      ///< of a mirror of any shape, that it is none of chance's, in nats
};

/// What a map does with one of the points that the score is measured at.
struct PointFit {
  std::size_t point = 0;  ///< which of them
  double weight = 0;      ///< what it counts: less where the map hardly moves it
  double support = 0;     ///< so much of that for the map; may be negative
  double missing = 0;     ///< so much of that is lost as the cloud has less where its image falls
  double rim = 0;         ///< so much of that is lost as the cloud has less around the point itself
  bool exact = false;     ///< its image is a point of the cloud, to rounding
};

/// The score of all kinds of mirror: the mean support of points spread evenly over the cloud.
///
/// A point whose image is a point of the cloud has support 1. Around any other the cloud and its
/// mirror image are compared within a ball. With r the distance of their means across the surface
/// and c = (n . n')^2 the consistency of their normals,
///
///   support = c / (1 + (r / near)^2) - penalty (r / far)^2 exp(1 - (r / far)^2):
///
/// near 1 where the image lies on the surface, negative where it just misses it, 0 in the void. The
/// balls have a fixed size, and the cloud is thinned to a fixed number of points: from some
/// thousand points on the score hardly depends on the sampling nor, as means lose noise, on noise.
/// Inside a volume, where any image has neighbours, only a partner nearer than chance would put it
/// counts.
class MirrorScore {
 public:
  /// What a cell of the thinned cloud counts: the same where it holds some points, so that density
  /// hardly matters, or as many as it holds, so that where cells divide a noisy surface does not.
  enum class Cells { alike, by_points };

  /// The cloud and its points must outlive the score. Collective, as all that follows.
  MirrorScore(const Cloud& cloud, const NearestPoints& points, const Context& context,
              Cells cells = Cells::alike);

  MirrorFit fit(const Mirror& mirror) const { return fit(mirror, 1); }
  /// The same of a third of the points: enough to see which mirrors are worth refining.
  MirrorFit glance(const Mirror& mirror) const { return fit(mirror, 3); }
  /// Of a rotation, a reflection or both, in the principal frame, what each point that it moves
  /// says; of every `stride`-th.
  std::vector<PointFit> point_fits(const Eigen::Isometry3d& map, std::size_t stride = 1) const;

  /// Sets the result's score, and "explained_share" and "exact_share" among its statistics.
  void fill(Result& result) const;

  /// The result with the best of at least one mirror, the others its candidates, best first.
  Result ranked(const std::string& method,
                const std::vector<std::shared_ptr<Mirror>>& mirrors) const;

 private:
  // The points in a ball, with weights that fall to 0 at its rim. In the principal frame.
  struct Ball {
    double count = 0;                // of points, sparse ones less
    double effective = 0;            // points of equal weight with the same variance
    Vector3 mean = Vector3::Zero();  // from the centre
    Matrix3 covariance = Matrix3::Zero();
  };
  // How a ball's points spread along their principal axes.
  struct Spread {
    Vector3 variances;  // ascending
    Matrix3 axes;
    Vector3 thinness;  // 0..1: 1 where they spread as little as a surface's, 0 as a volume's
    double flatness;   // 0..1: do they have a normal?

    Spread(const Matrix3& covariance, double radius);
    double surface() const { return thinness.maxCoeff(); }
  };
  struct Sample {
    Vector3 position;
    Ball ball;
    double surface;  // 0..1: how well the ball defines where the surface lies
    double density;  // 0..1: less where next to no others are, as among clutter

    double weight() const { return weighed(surface, 1, 1); }
    // Of what the surface, and what the inside of a body says, so much of each as there is.
    double weighed(double surface, double on_surface, double in_body) const;
  };

  struct Support {
    double on_surface;
    double missing, rim;  // 0..1: where the image's or the sample's ball has fewer points
    double surface;       // the sample's, where the image defines it better
  };

  MirrorFit fit(const Mirror& mirror, std::size_t stride) const;
  // image(x) in input units; image_ball(x), of the cloud's image around x, in the principal frame.
  template <typename Image, typename ImageBall>
  std::vector<PointFit> point_fits(const Image& image, const ImageBall& image_ball,
                                   std::size_t stride, MirrorLayers* layers,
                                   MirrorSides* sides) const;
  MirrorFit whole_of(const std::vector<PointFit>& points, std::size_t stride,
                     const MirrorLayers* layers, const MirrorSides* sides) const;
  void choose_radius();
  double measured_noise() const;
  // The thinned points, or their images.
  struct PointSet {
    PointSet(Points rows, std::vector<double> weights)
        : points(std::move(rows)), weights(std::move(weights)), tree(points) {}
    Points points;
    std::vector<double> weights;  // 0..1: less where the cloud is sparse, as among clutter
    PointTree tree;
  };

  Ball ball_of(const PointSet& set, const Vector3& x) const;
  static PointSet thinned(const Surfels& fine, Cells cells);
  PointSet mirrored(const Mirror& mirror) const;
  Support supported(const Sample& sample, const Ball& image) const;
  void add_sides(const Sample& sample, const Ball& image, const Vector3& to_image,
                 MirrorSides& sides) const;

  const Cloud& cloud_;
  const NearestPoints& points_;
  Surfels coarse_, fine_;
  PointSet thinned_;  // the means of fine cells
  double radius_;     // of the balls
  double noise_ = 0;  // standard deviation, in diagonals
  double moved_;      // displacement from which on a point counts in full
  std::vector<Sample> samples_;
};

/// The score: what is left of a fit after what mirrors of its kind fit by chance.
double score_of(const MirrorFit& fit, std::string_view kind);

/// The same of a result without the evidence of its sides, which says how sure a mirror is and not
/// how well it fits: what mirrors are ranked by. 0: chance fits as well.
double beyond_chance(const Result& result);

/// Of a mirror that others fit no better, none is surer: lowers the scores of its candidates.
void cap_candidates(Result& result);

}  // namespace symsurf
