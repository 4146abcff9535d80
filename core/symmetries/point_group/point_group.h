#pragma once

#include <symsurf/analyses.h>
#include <symsurf/context.h>
#include <symsurf/points.h>

#include <Eigen/Geometry>
#include <memory>
#include <string>
#include <vector>

#include "cloud/point_tree.h"

namespace symsurf {

/// A point group. Those that are made here stand upright: the main axis along z, and along x, in
/// this order of preference, the normal of a mirror that holds the main axis or an axis of order 2.
struct PointGroup {
  struct Axis {
    Vector3 direction;
    Index order;  ///< 0: continuous
  };

  PointGroup() = default;
  /// Named by its elements, the identity first; `continuous`: with any turn about z.
  explicit PointGroup(std::vector<Matrix3> elements, bool continuous = false);

  std::string name = "C1";                             ///< Schoenflies'
  std::vector<Matrix3> elements{Matrix3::Identity()};  ///< the identity first
  bool continuous = false;                             ///< any turn about z is an element, too
  bool all = false;                                    ///< K: any turn is

  std::vector<Vector3> plane_normals() const;
  std::vector<Axis> axes() const;  ///< the highest order first
  bool inversion() const;
};

/// What an axial group has beside the turns about its main axis.
struct AxialElements {
  bool across = false;    ///< the mirror across the main axis
  bool rotary = false;    ///< turns by half the least angle, then reflected across
  bool vertical = false;  ///< mirrors that hold the main axis, one with its normal along x
  bool twofold = false;   ///< axes of order 2 across it, one along x
};

/// `order` 0: continuous.
PointGroup axial_group(Index order, const AxialElements& elements);

PointGroup inversion_group();   ///< Ci
PointGroup reflection_group();  ///< Cs, its mirror across z
PointGroup spherical_group();   ///< K

/// T, O or I for the highest order of an axis, 3, 4 or 5, with more where it has a mirror.
PointGroup polyhedral_group(Index highest_order, bool inversion, bool mirror);

/// The group that the generators make, the identity first.
std::vector<Matrix3> closed(const std::vector<Matrix3>& generators);

bool contains(const std::vector<Matrix3>& elements, const Matrix3& element);

Matrix3 turn(const Vector3& axis, double angle);
Matrix3 reflection(const Vector3& normal);

/// Whether the lines along two unit vectors are, within an angle in radians.
bool are_parallel(const Vector3& a, const Vector3& b, double angle);

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
