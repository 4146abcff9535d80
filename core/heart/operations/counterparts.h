#pragma once

#include <symsurf/mirror.h>
#include <symsurf/operations.h>

#include <Eigen/Geometry>
#include <functional>
#include <limits>
#include <optional>
#include <string_view>
#include <vector>

#include "cloud/cloud.h"
#include "cloud/triangle_mesh.h"

namespace symsurf {

/// What a shape may be symmetric under: the reflection over a mirror, or a rotation.
class SymmetryMap {
 public:
  /// The mirror must stay alive.
  SymmetryMap(const Mirror& mirror) : mirror_(&mirror) {}
  explicit SymmetryMap(const Eigen::Isometry3d& rotation)
      : rotation_(rotation), inverse_(rotation.inverse()) {}

  std::string_view kind() const { return mirror_ ? mirror_->kind() : "axis"; }

  /// Whether it turns the winding of faces round, and is its own inverse.
  bool is_reflection() const { return mirror_ != nullptr; }

  SymmetryMap inverse() const { return mirror_ ? *this : SymmetryMap(inverse_); }

  /// NaN where there is none.
  Vector3 image(const Vector3& x) const { return mirror_ ? mirror_->reflect(x) : rotation_ * x; }
  /// What has the image x.
  Vector3 preimage(const Vector3& x) const { return mirror_ ? mirror_->reflect(x) : inverse_ * x; }

  /// From a mirror; of a rotation, which no point has to pass, 0.
  Eigen::VectorXd signed_distance(PointsView points, const Context& context) const {
    if (mirror_) return mirror_->signed_distance(points, context);
    return Eigen::VectorXd::Zero(points.size());
  }

  Points images(PointsView points, const Context& context) const {
    if (mirror_) return mirror_->reflect(points, context);
    return (points.matrix() * rotation_.linear().transpose()).rowwise() +
           rotation_.translation().transpose();
  }

 private:
  const Mirror* mirror_ = nullptr;
  Eigen::Isometry3d rotation_ = Eigen::Isometry3d::Identity(), inverse_ = rotation_;
};

/// Points nearer to the mirror than this lie on it, in diagonals: single precision.
constexpr double mirror_tolerance = 1e-6;

/// Where the homologous points of a shape's points lie on its mirror image.
struct HomologousPoints {
  Points displacements;  ///< from each point to it, smooth: on the image but for what is fine
  std::vector<Index> partners;  ///< of each point the one that it is the image of; -1: not known
  Eigen::VectorXd deviations;   ///< standard, of the part along the surface, input units
  Eigen::VectorXd known;        ///< share of its variance that the shape explains, 0 to 1
  /// Where partners count wherever they lie, and points without one have no counterpart: the side
  /// of the mirror that each belongs to, 1 or -1, 0: both; NaN without a partner. Else empty.
  Eigen::VectorXd sides = {};
  Values statistics = {};
};

/// Finds them. `images`: of the points, NaN where there are none.
using HomologousMatcher =
    std::function<HomologousPoints(const OperationInput& input, const SymmetryMap& map,
                                   PointsView images, const Context& context)>;

/// Those of a satellite.
struct Matchers {
  HomologousMatcher homologous;
  HomologousMatcher topological;
  HomologousMatcher vertex_pairs;  ///< partners by the triangles alone, without displacements
};

/// Where the other side of a shape says that one of its points should be: a point of the mirrored
/// surface, that is of the faces between the images of their corners. Of these that which reaches
/// beyond the mirror: no side is its own counterpart. Of a rotation, the turned surface.
struct Counterpart {
  Vector3 place = nowhere;       ///< that point; NaN where there is none
  Vector3 on_surface = nowhere;  ///< what it is the image of
  Index nearest = -1;  ///< a point of the input: of a cloud the one whose image is closest, of a
                       ///< mesh the corner of the face whose image is
  Index face = -1;     ///< of a mesh, whose image the place lies on
  Vector3 weights = Vector3::Zero();  ///< barycentric, of the face's corners
  double gap = 0;                     ///< from the point to the mirrored surface, input units
  double agreement = 0;               ///< cosine between the normals there, 0 to 1
  bool on_rim = false;                ///< the place is on a boundary of the mirrored mesh
  bool past_rim = false;  ///< the point lies beside the mirrored surface, not above it, or there
                          ///< is none of the other side
  /// Whose image is a point, or which is not past a rim, nor farther away or turned by more than
  /// allowed.
  bool matched = false;

  static inline const Vector3 nowhere = Vector3::Constant(std::numeric_limits<double>::quiet_NaN());
};

/// Of all points of a shape.
class Counterparts {
 public:
  struct Limits {
    double distance;  ///< from a point to the mirrored surface, input units
    double cosine;    ///< between the normals
  };

  /// A point is compared with the closest point of the mirrored surface, or with the one that
  /// `homologous` finds.
  /// Throws InvalidInput where the mirror has images for less than half of the points.
  Counterparts(const OperationInput& input, const SymmetryMap& map, const Limits& limits,
               const Context& context, const HomologousMatcher& homologous = nullptr);

  const Counterpart& operator[](Index i) const { return all_[i]; }
  /// How many points of the shape have a counterpart, without those of a second shape.
  Index matched() const { return matched_; }

  /// 0 to 1: the cosine between the normals, halved where the closest image of a point is a spacing
  /// away; of homologous points what is known of them. 0 without a counterpart.
  double confidence(Index i, PointsView points) const;

  /// Of all points the share without a counterpart, and what of it is so for which reason; a
  /// warning where little is known of homologous points.
  void report(Values& statistics) const;

  /// Where homologous points were asked for, not those of a pose.
  const HomologousPoints* homologous() const {
    return is_homologous_ && !is_by_topology() ? &homologous_ : nullptr;
  }

  /// From the mirror, input units; of posed points with the sign of the side that they belong to.
  double signed_distance(Index i) const { return distances_[i]; }

  /// Of a point, NaN where it has none.
  Vector3 image(Index i) const { return images_.row(i).transpose(); }
  /// What has the point for its image: over a mirror the same.
  Vector3 preimage(Index i) const {
    return map_.is_reflection() ? image(i) : Vector3(preimages_.row(i).transpose());
  }

  /// Unit normals, one a point: of a closed mesh outwards, of an open one by its winding, of a
  /// cloud away from its centroid.
  const Points& normals() const { return normals_; }

  /// Between neighbouring points, in input units: of a mesh the side of a square as large as a
  /// point's share of the area.
  double spacing() const { return spacing_; }

  /// Of a shape with faces.
  const TriangleMesh& mesh() const { return *mesh_; }

  /// Of a mesh that lies on one side of the mirror and ends there: the points where it ends are the
  /// only ones that have counterparts, themselves.
  bool is_half() const { return is_half_; }

  /// Of a mesh that is closed and without faces that a manifold has no room for.
  bool is_watertight() const { return is_watertight_; }

 private:
  void match_mesh(const OperationInput& input, const Context& context);
  void match_cloud(const OperationInput& input, const Context& context);
  void settle(Index i, double cosine);
  void settle_exact(Index i);
  bool is_by_topology() const { return homologous_.sides.size() > 0; }

  // From where the counterpart of a point is looked for.
  Vector3 query(PointsView points, Index i) const {
    if (!is_homologous_) return points[i];
    return points[i] + homologous_.displacements.row(i).transpose();
  }

  const SymmetryMap map_;
  const Limits limits_;
  const bool is_homologous_;
  const Index own_;              // points that the operation is done to
  HomologousPoints homologous_;  // where these are asked for
  std::vector<Counterpart> all_;
  std::optional<TriangleMesh> mesh_;
  Points images_, preimages_, normals_;  // preimages: of a rotation
  Eigen::VectorXd distances_;            // of the points, from the mirror, signed
  double spacing_ = 0;
  Index matched_ = 0;
  bool is_half_ = false, is_watertight_ = false;
};

/// Parameters that operations share, and the limits that they set.
Parameter max_distance();
Parameter max_angle();
Parameter pairing();
/// The matcher that "pairing" asks for; null for the closest points.
HomologousMatcher pairing_of(const ParameterValues& values, const Matchers& matchers);
Counterparts::Limits limits_of(const ParameterValues& values, PointsView points);

}  // namespace symsurf
