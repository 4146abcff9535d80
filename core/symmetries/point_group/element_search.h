#pragma once

#include <symsurf/context.h>

#include <optional>
#include <vector>

#include "cloud/point_tree.h"
#include "point_group/symmetry_fit.h"
#include "score/mirror_score.h"

namespace symsurf {

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

}  // namespace symsurf
