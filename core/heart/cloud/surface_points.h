#pragma once

#include <cmath>
#include <functional>
#include <span>
#include <string_view>
#include <vector>

#include "cloud/point_tree.h"

namespace symsurf {

/// Spacing of points spread over surfaces, in input units: from the median distance to the sixth
/// neighbour, since a disc of that radius holds six. Where every position holds `copies` points,
/// the distance to the sixth position. 0 where most points coincide.
double surface_spacing(PointsView points, const PointTree& tree, Index copies = 1);

/// The same about one of the points, from its neighbourhood: itself, then others, nearest first.
double spacing_at(const std::vector<Neighbour>& neighbourhood);

/// How a cloud lies around one of its points: its nearest others, of a weight that falls with the
/// distance as 1 - (d / radius)^2. Which of several as far as the last are counted does not matter.
struct NeighbourhoodMoments {
  double radius = 0;                     ///< how far the last lies
  Vector3 mean = Vector3::Zero();        ///< from the point, in radii
  Matrix3 covariance = Matrix3::Zero();  ///< in radii squared

  /// 0: as many on all sides; 5/16 at the flat face of a body full of points.
  double one_sided() const { return mean.norm(); }
};

/// Calls visit(v, moments of the k nearest others of the point tree.order()[positions[v]]) for
/// all of the positions, on several threads at once; fastest where they ascend.
void visit_neighbourhoods(
    PointsView points, const PointTree& tree, Index k, const std::vector<Index>& positions,
    const Context& context,
    const std::function<void(Index v, const NeighbourhoodMoments& around)>& visit);

/// estimate_normals() of points whose tree is there already.
Points estimate_normals(PointsView points, const PointTree& tree, Index neighbours,
                        std::string_view method, const Context& context);

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
  /// Of the points that drawn_with_images() gives, along the Z-order curve.
  SurfacePoints(const Points& all, Index count, const Context& context);

  Index size() const { return points.rows(); }
  Vector3 point(Index i) const { return points.row(i).transpose(); }
  Vector3 normal(Index i) const { return normals.row(i).transpose(); }

  /// How far off its partner an image may be for the points' spacing and their noise.
  double tolerance() const { return std::hypot(0.8 * spacing, 3 * noise); }

  Points points;
  PointTree tree;
  /// Nearest first; of fewer points, the point itself for those that are missing.
  Eigen::Matrix<std::int32_t, Eigen::Dynamic, ring, Eigen::RowMajor> neighbours;
  Points normals;            ///< unit, sign arbitrary; of the planes
  Eigen::VectorXd spacings;  ///< about each point
  double spacing = 0;        ///< the median of these
  double noise = 0;          ///< the median deviation from the planes
};

/// The rows of about `count` of the points, in the principal frame, drawn at random. Images over
/// the frame's planes, as those of exact mirrors are, are drawn together.
std::vector<Index> drawn_with_images(const Points& all, Index count);

}  // namespace symsurf
