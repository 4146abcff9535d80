#pragma once

#include <symsurf/context.h>
#include <symsurf/parameter.h>
#include <symsurf/points.h>

#include <concepts>
#include <memory>
#include <string_view>

namespace symsurf {

/// A triangulated piece of a mirror, in input units.
struct Mesh {
  Points vertices;
  Triangles triangles;
};

/// A surface of symmetry. Mirroring has one meaning for all kinds: x' = x + 2 (foot(x) - x),
/// where foot(x) is the point of the mirror that x maps through.
class Mirror {
 public:
  virtual ~Mirror() = default;

  /// "plane", "sphere", ...
  virtual std::string_view kind() const = 0;

  /// The foot of x: the closest point of a perpendicular mirror, the point along v of a
  /// fixed-direction one. NaN where x has no foot.
  virtual Vector3 foot(const Vector3& x) const = 0;

  /// Distance of x from its foot, signed by side. NaN where x has no foot.
  virtual double signed_distance(const Vector3& x) const = 0;

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
  /// Throws InvalidInput without points, or where they or their feet extend over more than 1e50 or
  /// the mesh would not be finite, InvalidParameter for a resolution out of 1 to 4096; Cancelled.
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
  virtual std::unique_ptr<Mirror> transformed(double scale, const Matrix3& rotation,
                                              const Vector3& translation) const = 0;

  /// Points that stand for the object in which the mirror was found; none for a mirror made by
  /// hand.
  PointsView footprint() const { return footprint_ ? PointsView(*footprint_) : PointsView(); }
  void set_footprint(std::shared_ptr<const Points> sample) { footprint_ = std::move(sample); }

 protected:
  Mirror() = default;
  Mirror(const Mirror&) = default;
  Mirror& operator=(const Mirror&) = default;

  /// False for points that are mirrored nowhere, although they have a foot.
  virtual bool has_image(const Vector3&) const { return true; }
  virtual Mesh mesh_over(PointsView object, int resolution, const Context& context) const = 0;

  static Vector3 no_point();

 private:
  std::shared_ptr<const Points> footprint_;
};

}  // namespace symsurf
