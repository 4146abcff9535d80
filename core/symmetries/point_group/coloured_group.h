#pragma once

#include <symsurf/analyses.h>
#include <symsurf/context.h>
#include <symsurf/points.h>

#include <Eigen/Geometry>
#include <memory>
#include <vector>

#include "cloud/point_tree.h"

namespace symsurf {

/// Even samples of a surface with colours, and whether maps take these onto themselves: nowhere may
/// most of a dozen samples next to each other differ by more than neighbours do.
class ColouredSurface {
 public:
  /// `colours`: a row a point; between the corners of a face they are interpolated. Points that are
  /// not finite have no say.
  ColouredSurface(PointsView points, TrianglesView faces, const Eigen::MatrixXd& colours,
                  const Context& context);

  bool is_kept_by(const Eigen::Isometry3d& map) const;

  /// The mean difference between the colour of a sample and that at its image, of about so many.
  double mean_difference(const Eigen::Isometry3d& map, Index looked) const;

  Index size() const { return points_.rows(); }

  /// Directions through the centre that symmetries of the colours may have: principal axes of the
  /// colours and of their edges.
  std::vector<Vector3> principal_directions(const Vector3& centre) const;

  /// The samples moved away from the centre by what their colours say, up to a quarter: a shape
  /// with the symmetries of the colours.
  Points relief(const Vector3& centre) const;

 private:
  void sample_points(PointsView points, const Eigen::MatrixXd& colours);
  void sample_faces(PointsView points, TrianglesView faces, const Eigen::MatrixXd& colours);
  Eigen::VectorXd values() const;
  double difference(Index one, Index other) const {
    return (colours_.col(one) - colours_.col(other)).norm();
  }
  double least_difference(Index sample, const Vector3& image) const;

  Points points_;
  Eigen::MatrixXd colours_;  // a column a sample, in units of the widest range of a channel
  std::unique_ptr<const PointTree> tree_;
  Eigen::Matrix<std::int32_t, Eigen::Dynamic, Eigen::Dynamic>
      near_;                   // a column a sample, itself first
  Eigen::VectorXd spread_;     // of each sample, how far the colours of its face's corners are
  std::vector<double> reach_;  // of each sample, input units: no farther it stands for the surface
  double limit_ = 0;
  Context context_;
};

/// The subgroup of a shape's symmetries that keeps the colours of its surface. Elements of a finite
/// group are tried one by one. Of a continuous axis the turns of any angle are, then those by the
/// primes up to 31 and their powers; mirrors and half turns along it are turned to where the
/// colours agree best.
Symmetries coloured_group(const Symmetries& found, const ColouredSurface& surface,
                          const Context& context);

}  // namespace symsurf
