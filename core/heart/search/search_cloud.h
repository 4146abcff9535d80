#pragma once

#include <vector>

#include "cloud/cloud.h"
#include "cloud/surface_points.h"

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

}  // namespace symsurf::perpendicular
