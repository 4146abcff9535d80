#pragma once

#include <vector>

#include "cloud/cloud.h"
#include "spatial/point_tree.h"

namespace symsurf::perpendicular {

/// The points a search works on: actual points of the cloud, evenly thinned when there are many,
/// about their centroid and in units of the diagonal.
struct SearchCloud {
  SearchCloud(const Cloud& cloud, Index most_points, const Context& context);

  static constexpr int ring = 12;  ///< neighbours a point is linked to

  Index size() const { return points.rows(); }
  Vector3 point(Index i) const { return points.row(i).transpose(); }
  Vector3 normal(Index i) const { return normals.row(i).transpose(); }

  Context context;  ///< asked in long loops whether to go on
  Vector3 centroid;
  double diagonal = 0;
  std::vector<Index> source;  ///< their indices in the cloud
  Points points;
  PointTree tree;
  Eigen::Matrix<std::int32_t, Eigen::Dynamic, ring, Eigen::RowMajor> neighbours;
  std::vector<double> local_spacing;  ///< from the sixth neighbour, r6 / sqrt(6 / pi)
  double spacing = 0;                 ///< the median of those
  double noise = 0;                   ///< standard deviation from the surface, before smoothing
  Points normals;                     ///< lines

  /// Whether the points scatter about their surface by enough to hide it.
  bool noisy() const;
  /// Draws every point to the surface it scatters about.
  void smooth();

 private:
  void measure();

  bool given_normals_ = false;
};

}  // namespace symsurf::perpendicular
