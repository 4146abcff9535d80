#pragma once

#include <symsurf/context.h>
#include <symsurf/points.h>

#include <Eigen/Geometry>
#include <cstdint>
#include <memory>
#include <vector>

#include "cloud/closest_point_on_mesh.h"
#include "cloud/cloud.h"
#include "cloud/point_tree.h"
#include "cloud/surface_points.h"

namespace symsurf {

/// How far a point lies off a shape.
struct Offset {
  double distance = 0;
  Vector3 direction = Vector3::Zero();  ///< unit, away from the shape
  bool missing = false;                 ///< beyond a rim: the shape may go on there
};

/// How far maps take a shape off itself.
struct MapDeviation {
  double greatest =
      0;  ///< distance; of a cloud that which medians of neighbours keep to, 98 % of them
  double quantile = 0;  ///< that 95 % of the samples of each map stay below
  double near = 1;      ///< share of the images that lie on the shape
  double missing = 0;   ///< share of the images beyond a rim, which do not count above
  /// Share of the samples of which hardly more than half of the images lie on the shape: not for a
  /// hole, which takes few images of many samples, but for what is there once only.
  double alone = 0;
};

/// Distances from a shape in its principal frame: of a mesh from its triangles, of a cloud from
/// planes through the neighbours of its points, of a small set from its points.
class SurfaceDistance {
 public:
  /// `shape`: a mesh, or points without faces. `is_set`: these are all there are.
  SurfaceDistance(const Cloud& shape, const PrincipalFrame& frame, bool is_set,
                  const Context& context);

  Offset operator()(const Vector3& x) const;

  /// The same to about a hundredth of the size, in nanoseconds, from a grid; `direction`: the slope
  /// of the distance.
  Offset rough(const Vector3& x) const;

  /// Of the worst of the maps, by about so many images in all. `within`: how far off images still
  /// lie on the shape, where that is more than its rounding.
  MapDeviation deviation(const std::vector<Eigen::Isometry3d>& maps, Index images,
                         double within = 0) const;

  /// In random order, even by area.
  const std::vector<Vector3>& samples() const { return samples_; }

  bool is_mesh() const { return mesh_ != nullptr; }
  bool is_set() const { return set_ != nullptr; }
  bool is_closed() const { return is_closed_; }  ///< a mesh without a rim
  double diameter() const { return diameter_; }  ///< the greatest distance of two points

  /// How far the shape may be off itself for the way in which it is given: the decimals of a set,
  /// the facets of a mesh, the spacing and noise of a cloud.
  double rounding() const { return rounding_; }

 private:
  void prepare_mesh(const Context& context);
  void prepare_cloud(const Context& context);
  void prepare_set(PointsView given, const PrincipalFrame& frame);
  void make_grid(const Points& dense);

  Points points_;
  Triangles faces_;
  std::unique_ptr<const ClosestPointOnMesh> mesh_;
  // Of a face, bits: the edges opposite its corners, then its corners; of a point any.
  std::vector<std::uint8_t> rims_;
  std::unique_ptr<const SurfacePoints> cloud_;
  std::unique_ptr<const PointTree> set_;
  std::vector<Vector3> samples_;
  std::vector<Index> order_;  // of the cloud's points among the samples
  bool is_closed_ = false;
  Index even_ = 0;  // samples; the others are vertices
  double diameter_ = 0, rounding_ = 0;

  Vector3 low_ = Vector3::Zero();
  double cell_ = 1;
  Eigen::Array<Index, 3, 1> cells_;
  std::vector<float> grid_;
};

}  // namespace symsurf
