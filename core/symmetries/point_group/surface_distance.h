#pragma once

#include <symsurf/context.h>
#include <symsurf/points.h>

#include <Eigen/Geometry>
#include <array>
#include <optional>
#include <vector>

#include "cloud/closest_point_on_mesh.h"
#include "cloud/cloud.h"
#include "cloud/point_tree.h"
#include "cloud/surface_points.h"

namespace symsurf {

constexpr double quantile_share = 0.95;  // of ImageDeviation::quantile

/// How far the images of a surface fall off it, in diameters.
struct ImageDeviation {
  double maximum = 0;   ///< over vertices and samples
  double quantile = 0;  ///< that 95 % of the samples by area do not exceed
  double missing = 0;   ///< share of the samples whose image falls beyond a rim: the rest counts

  /// The larger of each.
  void merge(const ImageDeviation& other);
};

/// Distances from a surface, in its principal frame with its diameter as the unit: exact ones to
/// triangles, for clouds to tangent planes, for at most 1000 points without faces to the points.
class SurfaceDistance {
 public:
  struct Foot {
    double distance = 0;
    Vector3 gradient = Vector3::Zero();  ///< of the distance, unit
    bool is_beyond_rim = false;
  };

  /// `given`: a mesh as it was given, otherwise the same cloud.
  SurfaceDistance(const Cloud& cloud, const Cloud& given, const Context& context);

  std::vector<Foot> feet(const std::vector<Vector3>& points) const;
  /// From a grid of 64 cells a side, of which it is off by up to one.
  Foot rough_foot(const Vector3& x) const;

  /// Looks at about so many images, half of them of samples by area; `turn`: which ones, where
  /// there are more.
  ImageDeviation deviation(const Eigen::Isometry3d& map, Index looked, Index turn = 0) const;

  const PrincipalFrame& frame() const { return frame_; }
  double diameter() const { return frame_.size; }
  /// Some 300 of the surface, even by area.
  const std::vector<Vector3>& samples() const { return samples_; }
  /// Points of the hull: the extreme ones in 120 directions.
  const std::vector<Vector3>& ends() const { return ends_; }

  /// Of the vertices of the mesh or the points of the cloud.
  Points vertices() const;
  bool is_closed() const { return is_closed_; }  ///< a mesh without a rim
  bool is_set() const { return set_.has_value(); }
  /// The median, by area, of how far the faces of a mesh may lie below the smooth surface that they
  /// are drawn of, in diameters; 0 of clouds.
  double sagitta() const { return sagitta_; }

 private:
  Foot foot_on_mesh(const Vector3& x) const;
  Foot foot_on_cloud(const Vector3& x, Index nearest) const;
  void sample_mesh(const Cloud& given, const Context& context);
  void sample_cloud(const Cloud& cloud, const Context& context);
  void find_ends();
  void make_grid();
  float& cell(Index i, Index j, Index k);

  PrincipalFrame frame_;
  std::vector<Vector3> vertices_, samples_, many_samples_, ends_;
  std::optional<ClosestPointOnMesh> mesh_;
  std::optional<PointTree> set_;
  std::optional<SurfacePoints> cloud_;
  Points normals_;  // of the faces
  Triangles faces_;
  std::vector<bool> is_rim_;  // of the vertices, or of the points of the cloud
  bool is_closed_ = false;
  double sagitta_ = 0, reach_ = 0;  // of the grid, from the centroid
  std::vector<float> grid_;
};

/// About `count` directions of the half sphere, spread evenly: a Fibonacci spiral.
std::vector<Vector3> even_directions(int count);

}  // namespace symsurf
