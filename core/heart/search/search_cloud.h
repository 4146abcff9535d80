#pragma once

#include <vector>

#include "cloud/cloud.h"
#include "cloud/surface_points.h"
#include "fit/fitted.h"

namespace symsurf::perpendicular {

/// The points a search works on: actual points of the cloud, evenly thinned when there are many, in
/// the principal frame, rounded to 1e-9 of it and in the order of their coordinates there. So the
/// same bits come of a cloud in any order, pose and unit, and what is drawn or grown from them.
struct SearchCloud : SurfacePoints {
  SearchCloud(const Cloud& cloud, Index most_points, const Context& context);

  Context context;  ///< checked in long loops
  // In input units.
  Vector3 centroid;
  Matrix3 axes;  ///< columns; right-handed
  double diagonal = 0;

  /// Whether the points scatter about their surface by enough to hide it.
  bool noisy() const;
  /// Draws every point to the surface it scatters about. The noise stays that of before.
  void smooth(const Context& progress);

 private:
  // All points of a cloud as they are searched; `order`: their rows in the cloud.
  struct Posed {
    Posed(const Cloud& cloud, const Context& context);

    Matrix3 axes;
    Points points;
    std::vector<std::int32_t> order;
  };

  SearchCloud(const Cloud& cloud, const Posed& posed, Index most_points, const Context& context);
  SearchCloud(const Cloud& cloud, const Posed& posed, const std::vector<Index>& rows,
              const Context& context);

  bool given_normals_;
};

/// The points of a search as what images meet, for fits: of the nearest few the one whose normal
/// fits as well, as across a thin part lies its other side.
class SearchMatcher {
 public:
  explicit SearchMatcher(const SearchCloud& cloud) : cloud_(cloud) {}

  double spacing() const { return cloud_.spacing; }
  double along_surface() const { return 0.08; }

  /// Of one map.
  template <typename Map>
  std::vector<Match> matches(const std::vector<Map>& maps, double limit) const {
    const Map& map = maps.front();
    std::vector<Match> found;
    for (const Index i : cloud_.tree.order()) {
      cloud_.context.check();
      const Vector3 x = cloud_.point(i), image = map.reflect(x);
      if (!image.allFinite()) continue;
      const Vector3 turned = map.reflect_direction(x, cloud_.normal(i));
      const Index partner = partner_of(image, turned, limit);
      if (partner >= 0)
        found.push_back(
            {x, {cloud_.normal(i), 1}, cloud_.point(partner), {cloud_.normal(partner), 1}});
    }
    return found;
  }

  /// The point that fits an image with this normal best, none farther off than the limit; -1: none.
  Index partner_of(const Vector3& image, const Vector3& normal, double limit) const;

 private:
  const SearchCloud& cloud_;
};

}  // namespace symsurf::perpendicular
