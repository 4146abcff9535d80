#pragma once

#include <symsurf/analyses.h>
#include <symsurf/context.h>

#include <Eigen/Geometry>
#include <cstddef>
#include <functional>
#include <optional>
#include <vector>

#include "cloud/cloud.h"
#include "cloud/point_tree.h"
#include "cloud/surfels.h"
#include "fit/refinement.h"
#include "point_group/point_group.h"
#include "score/mirror_score.h"

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
  static constexpr bool is_affine = true;
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

/// Of the surfels that an element moves so many must come so near to others, in diagonals: of a
/// guess, and of what was fitted to the surfels.
constexpr double glance_tolerance = 0.03, glance_support = 0.4;
constexpr double rough_tolerance = 0.015, rough_support = 0.45;

/// What the orbits of a cloud's points say of a group: of the images of a point under all elements,
/// how many lie on the cloud.
struct OrbitVote {
  double support = 0;   ///< share of the images on the surface, of those where the cloud has points
  double fit = 0;       ///< the mean of their supports, a measure of how close they come
  double missing = 0;   ///< share of the images that do
  double outliers = 0;  ///< share of the points that too few of their images confirm
  double share() const { return support * (1 - missing); }
};

/// Whether elements of a point group map a cloud onto itself: their pose is fitted, then the orbits
/// of the points vote.
class SymmetryTest {
 public:
  struct Passed {
    GroupPose pose;
    OrbitVote vote;
  };

  SymmetryTest(const Cloud& cloud, double minimum_score, const Context& context);

  /// The pose that fits them best, where they may be symmetries. With part of a shape missing two
  /// elements do not distinguish a hole from a feature: what spoils the symmetry is left to
  /// passes().
  std::optional<Passed> tried(const GroupPose& start, const std::vector<Matrix3>& elements) const {
    return tried(start, elements, elements);
  }
  /// Fits to some elements and lets the orbits under others vote.
  std::optional<Passed> tried(const GroupPose& start, const std::vector<Matrix3>& fitted,
                              const std::vector<Matrix3>& voting) const;

  /// The pose as it is, where they may be symmetries.
  std::optional<Passed> voted(const GroupPose& pose, const std::vector<Matrix3>& voting) const;

  /// Whether a group with these elements, some of those it has where it is continuous, is one of
  /// the cloud's.
  std::optional<Passed> passed(const GroupPose& start, const std::vector<Matrix3>& group,
                               bool continuous) const;

  const SymmetryFit& fit() const { return fit_; }
  const Surfels& coarse() const { return coarse_; }

 private:
  bool may_be(const OrbitVote& vote) const;

  double minimum_score_;
  NearestPoints points_;
  const Surfels &coarse_, &fine_;
  MirrorScore score_;
  SymmetryFit fit_;
};

/// Turns by k / order of a full turn, k = 1, 2, ... at most `most` of them.
std::vector<Matrix3> turns_of(Index order, std::size_t most = 128);

/// Turns about an axis that are those of no order up to hundreds.
std::vector<Matrix3> any_turns(const Vector3& axis, int count);

/// The elements of a group, those of a continuous one with eight turns about each axis.
std::vector<Matrix3> tested_elements(const PointGroup& group);

/// A mirror plane, by its normal, or a rotation axis that a cloud may have.
struct FoundDirection {
  GroupPose pose;  ///< z along it
  OrbitVote vote;
  Index order = 1;  ///< of the axis; 0: continuous
  Vector3 z() const { return pose.axes.col(2); }
};

constexpr double same_direction = 0.05;  // radians, of directions fitted well: 3 degrees

/// Some of the planes, the best first: all others follow from a few.
std::vector<FoundDirection> find_planes(const SymmetryTest& test);

/// Nearest to all planes, and where these leave it free to the centroid.
Vector3 centre_of(const std::vector<FoundDirection>& planes);

/// Axes along the lines in which planes meet, their normals and the principal axes, where these
/// are any those of half turns between surfels; the highest order first, continuous ones before.
/// Where one is continuous, or two are of order 3 or more, as in a polyhedral group, and fit well,
/// the search ends.
std::vector<FoundDirection> find_axes(const SymmetryTest& test,
                                      const std::vector<FoundDirection>& planes,
                                      const Vector3& centre);

/// The axis of a surface of revolution of which part of the turn is there.
struct Revolution {
  FoundDirection axis;  ///< the vote is that of turns by parts of what is there
  double turn = 0;      ///< the share of the full turn that is there, (0, 1]
};

/// All normals of a surface of revolution meet its axis: a linear line complex (Pottmann and
/// Randrup, "Rotational and helical surface approximation for reverse engineering", 1998), from
/// random samples, then by weights. Then the points, turned into one half plane, are to scatter
/// least about a profile. None where turns of the cloud do not fit it.
std::optional<Revolution> find_revolution(const Cloud& cloud, const SymmetryTest& test,
                                          const Context& context);

/// A point group that stands in a pose of the principal frame, in input units.
Symmetries described(const PointGroup& group, const GroupPose& pose, const OrbitVote& vote,
                     const PrincipalFrame& frame);

/// The point group of a validated cloud in one process. Elements are proposed by candidate planes,
/// by the lines that these meet in and by the principal axes; the groups that they may make are
/// fitted and judged as a whole, the largest first. Of a surface of revolution any part of the turn
/// may be missing. `accepts`: whether a group that was found is one.
Symmetries search_symmetries(const Cloud& cloud, double minimum_score,
                             const std::function<bool(const Symmetries&)>& accepts,
                             const Context& context);

/// The axis of the highest order, continuous ones first, or that of what is mostly a surface of
/// revolution, whatever spoils it, as a handle or a broken edge does. Throws what find_symmetries()
/// does.
std::optional<SymmetryAxis> find_axis(PointsView points, TrianglesView faces,
                                      const Context& context);

}  // namespace symsurf
