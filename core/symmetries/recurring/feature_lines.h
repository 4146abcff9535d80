#pragma once

#include <symsurf/context.h>
#include <symsurf/points.h>

#include <array>
#include <vector>

namespace symsurf {

struct CloudFacets;

/// A stretch of sharp edges from one corner to the next, or around to its beginning.
struct FeatureLine {
  static constexpr int steps = 8;

  Index start = -1, end = -1;  ///< corners; -1 both: closed, and smooth all around
  double length = 0;
  std::array<Vector3, steps> samples;  ///< at equal steps along it, beginning with the start
  /// Unit vectors across the line into the facets at its middle: they say how the surface bends.
  std::vector<Vector3> wings;
  double wing_error = 0;      ///< radians that noise may have turned them by
  std::vector<Index> points;  ///< of the mesh, or of the cloud the nearest to samples

  bool has_ends() const { return start >= 0; }
  const Vector3& middle() const { return samples[steps / 2]; }
};

/// The feature lines of a shape with the graph that they are the edges of.
struct FeatureLines {
  std::vector<FeatureLine> lines;
  std::vector<Vector3> corners;
  std::vector<std::vector<Index>> at;  ///< the lines at each corner, ascending; both ends may be
  double noise = 0;                    ///< standard deviation of the points
};

/// The lines along which nearly flat facets meet at more than `angle` radians, or end (Bokeloh et
/// al. 2009). They meet in corners, where one bends by more than that, or where another number of
/// edges than two come together. Points at the same place are one.
FeatureLines feature_lines(PointsView points, TrianglesView faces, double angle,
                           const Context& context);

/// Of a cloud: where its planar facets cross, up to the corners of three.
FeatureLines feature_lines(const CloudFacets& cloud, double angle, const Context& context);

}  // namespace symsurf
