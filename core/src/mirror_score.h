#pragma once

#include <symsurf/context.h>
#include <symsurf/method.h>
#include <symsurf/mirror.h>
#include <symsurf/result.h>

#include <array>
#include <cmath>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "nearest_points.h"
#include "plane/surfels.h"
#include "sheet_places.h"

namespace symsurf {

/// What an image says for or against a mirror: 1 where it meets the cloud's surface, minus the
/// objection where it just misses it, 0 far from it. A true mirror of a shape with a piece missing
/// sends images into the void, a wrong one sends them past the surface everywhere.
struct Testimony {
  double meets = 0.0015, misses = 0.016;  ///< distances from the surface, over the cloud's size
  double objection = 0.7;                 ///< what a miss counts

  /// The same of a cloud whose points are that far off their surface.
  Testimony of(double rough) const {
    return {std::hypot(meets, rough), std::hypot(misses, 2 * rough), objection};
  }

  /// `facing`, 0..1: do the normals mirror each other?
  double operator()(double residual, double facing) const {
    const double near = residual / meets, past = residual / misses;
    return facing / (1 + near * near) - objection * past * past * std::exp(1 - past * past);
  }
};

/// How far an image is from the cloud's surface, `gap` from its partner. Along a sheet, or inside a
/// blob, a partner is as near as the points' spacing allows: only what exceeds it counts.
double distance_past(const Vector3& gap, const Facet& partner, double spacing);

/// What a mirror explains of a cloud, before the discount for its freedom; both in [0, 1].
struct Explained {
  double share = 0;
  double exactly = 0;       ///< share of what the mirror moves whose image is a point, to rounding
  double single_layer = 0;  ///< of a mirror of any shape, how far any such cloud has one
};

/// The one score of all kinds of mirror: the mean testimony of the points that the mirror moves (at
/// least 35 % of all), over that of the points about their own nearest neighbours, since a perfect
/// mirror maps the cloud onto another sample of the same sheets. From that is taken what a mirror
/// of the same freedom explains of random clouds, which have no exact partners; and of a mirror
/// that may have any shape what speaks for nothing, as it fits every cloud of a single layer.
class MirrorScore {
 public:
  /// The cloud and its points must outlive the score.
  MirrorScore(const Cloud& cloud, const NearestPoints& points, const Context& context);

  Explained explained(const Mirror& mirror) const;

  /// Sets the result's score, and "explained_share" and "exact_share" among its statistics.
  void fill(Result& result) const;

  /// The result with the best of at least one mirror, the others its candidates, best first. The
  /// first `settled` of them stay in front as they are.
  Result ranked(const std::string& method, const std::vector<std::shared_ptr<Mirror>>& mirrors,
                Index settled = 0) const;

 private:
  // Where the samples lie, and what their own nearest neighbours say.
  struct Neighbours {
    std::vector<Located> samples;
    double roughness = 0;  // how far they miss each other's surface
    Testimony testimony;
    double moved_tolerance = 0.01;
    double explain = 0;
  };

  void take_samples();
  void look_at_neighbours();
  Neighbours said(const std::vector<Vector3>& nearest, NoiseIs noise) const;
  const Neighbours& neighbours(NoiseIs noise) const {
    return neighbours_[static_cast<std::size_t>(noise)];
  }
  const Surfel* surfel_at(const Vector3& x) const { return flattest_at({&coarse_, &fine_}, x); }

  const Cloud& cloud_;
  const NearestPoints& points_;
  Surfels coarse_, fine_;
  double spacing_;  // of the points on a sheet
  std::vector<OnSheet> samples_;
  SheetPlaces places_;
  std::array<Neighbours, 3> neighbours_;  // by what becomes of the noise
};

/// What is left of a share explained after what chance explains, for a kind of mirror.
double discounted(const Explained& explained, std::string_view kind);

}  // namespace symsurf
