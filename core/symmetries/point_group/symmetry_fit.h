#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <vector>

#include "cloud/cloud.h"
#include "cloud/point_tree.h"
#include "cloud/surfels.h"
#include "fit/refinement.h"

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

/// An element of a point group as it stands in a pose, whose small turn and shift a fit looks for.
class PosedElement {
 public:
  using Change = Eigen::Vector<double, 6>;
  static constexpr bool is_rigid = true;
  /// Directions that the elements leave free, as along an axis, stay as they are.
  static constexpr double ridge = 1e-5;

  PosedElement(const GroupPose& pose, const Matrix3& element);

  const GroupPose& pose() const { return pose_; }

  /// What it maps x to; half the way there; the normal at the image of a surface with normal n.
  Vector3 reflect(const Vector3& x) const { return map_ * x; }
  double distance(const Vector3& x) const { return (reflect(x) - x).norm() / 2; }
  Vector3 reflect_direction(const Vector3& /*x*/, const Vector3& n) const {
    return map_.linear() * n;
  }

  /// What GaussNewton asks for.
  Eigen::Matrix<double, 3, 6> slopes(const Vector3& x) const;
  std::pair<PosedElement, double> stepped(const Change& by) const;
  void follow(const PosedElement& moved) { *this = {moved.pose_, element_}; }

 private:
  GroupPose pose_;
  Matrix3 element_;
  Eigen::Isometry3d map_;
};

/// Fits the pose of some elements of a point group to a cloud, of all at once, so that they stay a
/// group.
class SymmetryFit {
 public:
  SymmetryFit(const Cloud& cloud, const NearestPoints& points, const Surfels& coarse,
              const Surfels& fine);

  /// On the surfels, from some 5 degrees and a 20th of the diagonal away.
  GroupPose roughly(const GroupPose& pose, const std::vector<Matrix3>& elements) const;

  /// On the full cloud, from a degree away; looks at about so many samples a step.
  GroupPose closely(const GroupPose& pose, const std::vector<Matrix3>& elements,
                    std::size_t looked) const;

  /// The share of the surfels, of those it moves, that an element maps within `tolerance` of the
  /// surface, in diagonals.
  double support(const GroupPose& pose, const Matrix3& element, double tolerance) const;

  /// The greatest share of points next to each other that too few of their images under the
  /// elements confirm: near 1 where a small part breaks a symmetry of the rest, as the spinner of a
  /// propeller does when the propeller is turned over.
  double worst_window(const GroupPose& pose, const std::vector<Matrix3>& elements) const;

 private:
  std::vector<bool> on_surface(const std::vector<Vector3>& images) const;

  const Cloud& cloud_;
  const NearestPoints& points_;
  const Surfels &coarse_, &fine_;
  SurfelMap map_;
  Refinement refinement_;
};

}  // namespace symsurf
