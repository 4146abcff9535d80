#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <vector>

#include "cloud/cloud.h"
#include "cloud/point_tree.h"
#include "cloud/surfels.h"

namespace symsurf {

/// Where a point group stands in the principal frame.
struct GroupPose {
  Matrix3 axes = Matrix3::Identity();  ///< columns: where its x, y and z point, right-handed
  Vector3 centre = Vector3::Zero();

  /// An element, given in the group's standard orientation, as it stands here.
  Eigen::Isometry3d placed(const Matrix3& element) const;

  /// Of groups with z along a direction; x wherever.
  static GroupPose along(const Vector3& z, const Vector3& centre);
};

/// Fits the pose of some elements of a point group to a cloud: Gauss-Newton steps on robust
/// correspondences, as for planes, but of all elements at once, so that they stay a group.
class SymmetryFit {
 public:
  SymmetryFit(const Cloud& cloud, const PointTree& tree, const NearestPoints& points,
              const Surfels& coarse, const Surfels& fine);

  /// On the surfels, from some 5 degrees and a 20th of the diagonal away.
  GroupPose roughly(GroupPose pose, const std::vector<Matrix3>& elements) const;

  /// On the full cloud, from a degree away; looks at about so many samples a step.
  GroupPose closely(GroupPose pose, const std::vector<Matrix3>& elements, std::size_t looked) const;

  /// The share of the surfels, of those it moves, that an element maps within `tolerance` of the
  /// surface, in diagonals.
  double support(const GroupPose& pose, const Matrix3& element, double tolerance) const;

  /// The greatest share of points next to each other that too few of their images under the
  /// elements confirm: near 1 where a small part breaks a symmetry of the rest, as the spinner of a
  /// propeller does when the propeller is turned over.
  double worst_window(const GroupPose& pose, const std::vector<Matrix3>& elements) const;

 private:
  struct Match {
    Vector3 point, image, partner;
    const Surfel *own, *other;
  };
  class Step;

  const Surfel* surfel_at(const Vector3& x) const { return flattest_at({&coarse_, &fine_}, x); }
  SurfaceNoise measured_noise() const;
  std::vector<bool> on_surface(const std::vector<Vector3>& images) const;
  std::vector<Match> on_surfels(const Eigen::Isometry3d& map, std::size_t stride) const;
  std::vector<Match> on_cloud(const Eigen::Isometry3d& map, double reach, std::size_t stride) const;

  const Cloud& cloud_;
  const NearestPoints& points_;
  const Surfels &coarse_, &fine_;
  SurfelMap map_;
  SurfaceNoise noise_;
  double spacing_;  // of the points, diagonals
};

}  // namespace symsurf
