#pragma once

#include <span>
#include <vector>

#include "cloud/point_tree.h"

namespace symsurf {

/// Spacing of points spread over surfaces, in input units: from the median distance to the sixth
/// neighbour, since a disc of that radius holds six. Where every position holds `copies` points,
/// the distance to the sixth position. 0 where most points coincide.
double surface_spacing(PointsView points, const PointTree& tree, Index copies = 1);

/// The same about one of the points, from its neighbourhood: itself, then others, nearest first.
double spacing_at(const std::vector<Neighbour>& neighbourhood);

/// The plane through a neighbourhood, by principal components.
struct LocalPlane {
  Matrix3 axes;          ///< columns, the normal first
  double deviation = 0;  ///< standard, of the points from it
};
LocalPlane plane_through(const Points& points, std::span<const Neighbour> neighbourhood);

/// Points on surfaces with their nearest neighbours, the planes through these and the spacing.
struct SurfacePoints {
  static constexpr int ring = 12;  ///< neighbours of a point

  /// The planes are those through `neighbourhood` points, each point itself among them.
  SurfacePoints(Points positions, const Context& context, Index neighbourhood = ring);
  /// Of `count` of the points, in the principal frame and drawn at random, along the Z-order curve.
  /// Images over the frame's planes, as those of exact mirrors are, are drawn together.
  SurfacePoints(const Points& all, Index count, const Context& context);

  Index size() const { return points.rows(); }
  Vector3 point(Index i) const { return points.row(i).transpose(); }
  Vector3 normal(Index i) const { return normals.row(i).transpose(); }

  Points points;
  PointTree tree;
  /// Nearest first; of fewer points, the point itself for those that are missing.
  Eigen::Matrix<std::int32_t, Eigen::Dynamic, ring, Eigen::RowMajor> neighbours;
  Points normals;            ///< unit, sign arbitrary; of the planes
  Eigen::VectorXd spacings;  ///< about each point
  double spacing = 0;        ///< the median of these
  double noise = 0;          ///< the median deviation from the planes
};

/// The rows of `count` of the points, or of all where there are no more, spread along the Z-order
/// curve and in its order: dense where the points are dense.
std::vector<Index> spread_along_curve(PointsView points, Index count, const Context& context);

}  // namespace symsurf
