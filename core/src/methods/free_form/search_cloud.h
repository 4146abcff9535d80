#pragma once

#include <vector>

#include "cloud/cloud.h"
#include "cloud/surface_points.h"

namespace symsurf::perpendicular {

/// The points a search works on: actual points of the cloud, evenly thinned when there are many,
/// about their centroid and in units of the diagonal.
struct SearchCloud : SurfacePoints {
  SearchCloud(const Cloud& cloud, Index most_points, const Context& context);

  Context context;  ///< checked in long loops
  Vector3 centroid;
  double diagonal = 0;

  /// Whether the points scatter about their surface by enough to hide it.
  bool noisy() const;
  /// Draws every point to the surface it scatters about. The noise stays that of before.
  void smooth(const Context& progress);

 private:
  SearchCloud(const Cloud& cloud, const std::vector<Index>& rows, const Context& context);

  bool given_normals_;
};

}  // namespace symsurf::perpendicular
