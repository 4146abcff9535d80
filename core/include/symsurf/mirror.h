#pragma once

#include <symsurf/context.h>
#include <symsurf/parameter.h>
#include <symsurf/points.h>

#include <concepts>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

namespace symsurf {

/// A triangulated piece of a mirror, in input units.
struct Mesh {
  Points vertices;
  Triangles triangles;
};

/// The point of a mirror that another point x maps through.
struct Foot {
  Vector3 point;    ///< the image of x is x + 2 (point - x)
  Vector3 normal;   ///< of the mirror's surface there, of length 1, towards positive distances
  double distance;  ///< of x from the point, signed by side
};

/// A surface of symmetry. Mirroring has one meaning for all kinds: x' = x + 2 (foot(x) - x),
/// where foot(x) is the point of the mirror that x maps through.
class Mirror {
 public:
  virtual ~Mirror() = default;

  /// "plane", "sphere", ...
  virtual std::string_view kind() const = 0;

  /// The foot of x: the closest point of a perpendicular mirror, the point along v of a
  /// fixed-direction one. None where x has no foot.
  virtual std::optional<Foot> at(const Vector3& x) const = 0;

  /// The unit direction that x maps along: x = foot.point + foot.distance * direction.
  virtual Vector3 direction(const Foot& foot) const { return foot.normal; }

  /// The point of the foot, NaN where x has none.
  Vector3 foot(const Vector3& x) const;

  /// The distance of x from its foot, NaN where it has none.
  double signed_distance(const Vector3& x) const;

  /// The derivative of the foot by the point that has it.
  Matrix3 foot_jacobian(const Foot& foot) const;

  /// The derivative of the image of x by x, NaN where it has none.
  Matrix3 jacobian(const Vector3& x) const;

  /// The image of x, NaN where it has none.
  Vector3 reflect(const Vector3& x) const;
  Points reflect(PointsView points, const Context& context = {}) const;
  /// The feet. Throws Cancelled, as the others of many points do.
  Points project(PointsView points, const Context& context = {}) const;
  Eigen::VectorXd signed_distance(PointsView points, const Context& context = {}) const;
  // Eigen would make a Vector3 of Points as readily as a view of them.
  template <std::same_as<Points> Many>
  Points reflect(const Many& points, const Context& context = {}) const {
    return reflect(PointsView(points), context);
  }
  template <std::same_as<Points> Many>
  Eigen::VectorXd signed_distance(const Many& points, const Context& context = {}) const {
    return signed_distance(PointsView(points), context);
  }

  /// Triangles over the footprint of the object: the part of the mirror that lies between the
  /// object's points and their images. `resolution` is the number of cells along the longer side.
  /// Throws InvalidInput without points, or where none has an image, they or their feet extend over
  /// more than 1e50 or the mesh would not be finite, InvalidParameter for a resolution out of 1 to
  /// 4096; Cancelled.
  Mesh mesh(PointsView object, int resolution = 32, const Context& context = {}) const;
  /// The same over the object in which the mirror was found.
  Mesh mesh(int resolution = 32, const Context& context = {}) const {
    return mesh(footprint(), resolution, context);
  }

  /// The numbers that define the mirror, by their public names ("normal", "offset").
  virtual Values numbers() const = 0;

  /// Whether the other is of the same kind and has the same numbers, to the last bit; footprints
  /// may differ.
  bool operator==(const Mirror& other) const;

  /// The mirror after x -> scale * rotation * x + translation.
  std::unique_ptr<Mirror> transformed(double scale, const Matrix3& rotation,
                                      const Vector3& translation) const {
    return moved({scale, rotation, translation});
  }

  /// Points that stand for the object in which the mirror was found; none for a mirror made by
  /// hand.
  PointsView footprint() const { return footprint_ ? PointsView(*footprint_) : PointsView(); }
  void set_footprint(std::shared_ptr<const Points> sample) { footprint_ = std::move(sample); }

 protected:
  Mirror() = default;
  Mirror(const Mirror&) = default;
  Mirror& operator=(const Mirror&) = default;

  /// x -> scale * rotation * x + translation.
  struct Motion {
    double scale = 1;
    Matrix3 rotation = Matrix3::Identity();
    Vector3 translation = Vector3::Zero();

    Vector3 operator()(const Vector3& x) const { return scale * (rotation * x) + translation; }
  };

  /// False for points that are mirrored nowhere, although they have a foot.
  virtual bool has_image(const Foot&) const { return true; }
  /// The derivative of the unit normal along the surface of a perpendicular mirror, 0 across it.
  virtual Matrix3 shape_operator(const Foot&) const { return Matrix3::Zero(); }
  virtual std::unique_ptr<Mirror> moved(const Motion& by) const = 0;
  /// The part of the mirror over at least one of its feet.
  virtual Mesh mesh_over(const std::vector<Foot>& feet, int resolution,
                         const Context& context) const = 0;

 private:
  std::shared_ptr<const Points> footprint_;
};

}  // namespace symsurf
