#pragma once

// The kinds of mirror, how they are made, and what else they do: bend a shape, reflect light.

#include <symsurf/context.h>
#include <symsurf/mirror.h>
#include <symsurf/points.h>

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace symsurf {

/// The plane normal . x + offset = 0.
class Plane final : public Mirror {
 public:
  /// The normal may have any length but zero; it and the offset are divided by that length.
  /// Throws InvalidInput for a zero or non-finite normal or a non-finite offset.
  Plane(const Vector3& normal, double offset);

  const Vector3& normal() const { return normal_; }
  double offset() const { return offset_; }
  /// The plane's point closest to the origin of the coordinates.
  Vector3 origin() const { return -offset_ * normal_; }
  /// A right-handed frame, a unit vector a row: two within the plane, then the normal. The first is
  /// orthogonal to the coordinate axis that the normal leans towards least; of equal ones the
  /// first.
  Matrix3 axes() const;

  /// The reflection as a 4 x 4 matrix on homogeneous columns (x, y, z, 1).
  Matrix4 matrix() const;

  std::string_view kind() const override { return "plane"; }
  std::optional<Foot> at(const Vector3& x) const override {
    const double distance = normal_.dot(x) + offset_;
    return Foot{x - distance * normal_, normal_, distance};
  }
  Values numbers() const override;

 private:
  std::unique_ptr<Mirror> moved(const Motion& by) const override;
  Mesh mesh_over(const std::vector<Foot>& feet, int resolution,
                 const Context& context) const override;

  Vector3 normal_;
  double offset_;
};

/// The plane normal . x + offset = 0 with a direction of its own: x' = x - 2 (normal . x + offset)
/// / (normal . direction) direction. A body that is sheared after it was symmetric has this mirror.
class ObliquePlane final : public Mirror {
 public:
  /// Normal and direction may have any length but zero; the normal and the offset are divided by
  /// that of the normal, and the direction points to its side.
  /// Throws InvalidInput for a zero or non-finite normal or direction, a non-finite offset, and a
  /// direction less than 0.01 degrees off the plane.
  ObliquePlane(const Vector3& normal, double offset, const Vector3& direction);

  const Vector3& normal() const { return plane_.normal(); }
  double offset() const { return plane_.offset(); }
  const Vector3& direction() const { return direction_; }
  Vector3 direction(const Foot&) const override { return direction_; }
  /// The angle between direction and normal, radians, from 0 on to less than a right angle.
  double obliquity() const;

  /// The reflection as a 4 x 4 matrix on homogeneous columns (x, y, z, 1).
  Matrix4 matrix() const;

  std::string_view kind() const override { return "oblique plane"; }
  std::optional<Foot> at(const Vector3& x) const override {
    const double distance = (normal().dot(x) + offset()) / normal().dot(direction_);
    return Foot{x - distance * direction_, normal(), distance};
  }
  Values numbers() const override;

 private:
  std::unique_ptr<Mirror> moved(const Motion& by) const override;
  Mesh mesh_over(const std::vector<Foot>& feet, int resolution,
                 const Context& context) const override;

  Plane plane_;
  Vector3 direction_;
};

/// The sphere |x - centre| = radius. A point is mirrored along the radius, |x' - c| = 2r - |x - c|
/// (not inversion), so the centre and points farther than 2r from it have no image.
class Sphere final : public Mirror {
 public:
  /// Throws InvalidInput for a non-finite centre or a radius that is not finite and above 0.
  Sphere(const Vector3& centre, double radius);

  const Vector3& centre() const { return centre_; }
  double radius() const { return radius_; }

  std::string_view kind() const override { return "sphere"; }
  /// The distance is positive outside. None at the centre.
  std::optional<Foot> at(const Vector3& x) const override;
  Values numbers() const override;

 private:
  bool has_image(const Foot& foot) const override { return foot.distance <= radius_; }
  Matrix3 shape_operator(const Foot& foot) const override;
  std::unique_ptr<Mirror> moved(const Motion& by) const override;
  /// The cap about the mean direction of the feet.
  Mesh mesh_over(const std::vector<Foot>& feet, int resolution,
                 const Context& context) const override;

  Vector3 centre_;
  double radius_;
};

/// The circular cylinder |(x - point) - ((x - point) . axis) axis| = radius. A point is mirrored
/// along the radius, so points on the axis and points farther than 2r from it have no image.
class Cylinder final : public Mirror {
 public:
  /// The axis may have any length but zero; it is divided by that length.
  /// Throws InvalidInput for a non-finite point or axis, a zero axis or a radius that is not finite
  /// and above 0.
  Cylinder(const Vector3& point, const Vector3& axis, double radius);

  const Vector3& point() const { return point_; }
  const Vector3& axis() const { return axis_; }
  double radius() const { return radius_; }

  std::string_view kind() const override { return "cylinder"; }
  /// The distance is positive outside. None on the axis.
  std::optional<Foot> at(const Vector3& x) const override;
  Values numbers() const override;

 private:
  bool has_image(const Foot& foot) const override { return foot.distance <= radius_; }
  Matrix3 shape_operator(const Foot& foot) const override;
  std::unique_ptr<Mirror> moved(const Motion& by) const override;
  /// The shell over the angles and heights of the feet.
  Mesh mesh_over(const std::vector<Foot>& feet, int resolution,
                 const Context& context) const override;

  Vector3 point_, axis_;
  double radius_;
};

/// The quadric f(x) = x' A x + b . x + c = 0, mirrored perpendicularly over its closest point.
class Quadric final : public Mirror {
 public:
  /// A is made symmetric. Throws InvalidInput for numbers that are not finite, or when A and b are
  /// zero.
  Quadric(const Matrix3& matrix, const Vector3& linear, double constant);
  /// The same about a point: f(x) = (x - o)' A (x - o) + g . (x - o) + f(o), g the gradient there.
  /// Near the object it keeps the digits that b and c lose far from the coordinates' own origin.
  Quadric(const Matrix3& matrix, const Vector3& origin, const Vector3& gradient, double value);

  const Matrix3& matrix() const { return matrix_; }
  Vector3 linear() const { return linear_ - 2 * (matrix_ * origin_); }
  double constant() const { return value(Vector3::Zero()); }

  double value(const Vector3& x) const {
    const Vector3 d = x - origin_;
    return d.dot(matrix_ * d) + linear_.dot(d) + constant_;
  }
  Vector3 gradient(const Vector3& x) const { return 2 * (matrix_ * (x - origin_)) + linear_; }

  std::string_view kind() const override { return "quadric"; }
  /// The closest point: y = (I + 2 l A)^-1 (x - l b) for the one l with f(y) = 0 between the poles
  /// on either side of 0, its distance positive where f is. None on the inner focal set, or without
  /// real points.
  std::optional<Foot> at(const Vector3& x) const override;
  /// "matrix" (3 x 3), "linear", "constant"; about a point near the object "origin", "gradient" and
  /// "value". One made from numbers with the latter is made from those.
  Values numbers() const override;

 private:
  Matrix3 shape_operator(const Foot& foot) const override;
  std::unique_ptr<Mirror> moved(const Motion& by) const override;
  Mesh mesh_over(const std::vector<Foot>& feet, int resolution,
                 const Context& context) const override;

  // Far from the coordinates' own origin the terms cancel.
  Vector3 origin_ = Vector3::Zero();
  Matrix3 matrix_;
  Vector3 linear_;
  double constant_;
  Matrix3 axes_;    // eigenvectors of A
  Vector3 curves_;  // its eigenvalues
};

/// One of the thesis's functions f(x, y) whose graphs serve as mirrors and as point clouds.
struct Surface {
  std::string name;     ///< "f1"
  std::string formula;  ///< "sin(0.7 x) cos(0.7 y)"
  double (*height)(double x, double y) = nullptr;
  Eigen::Vector2d (*slope)(double x, double y) = nullptr;

  /// f(x, y); NaN where it is undefined (f6 outside the unit disc).
  double operator()(double x, double y) const { return height(x, y); }
  /// (df/dx, df/dy); 0 across a crease or tip, not finite where f is undefined or vertical.
  Eigen::Vector2d gradient(double x, double y) const { return slope(x, y); }
};

/// f1 to f6.
const std::vector<Surface>& surfaces();

/// Throws InvalidParameter, listing the names there are.
const Surface& surface(std::string_view name);

/// "f1", ..., "f6".
std::vector<std::string> surface_names();

/// Which way a point is mirrored over a surface.
enum class Mapping { Fixed, Perpendicular };

/// The graph of a known surface as a mirror: the truth of generated samples. In the surface's own
/// frame it is z = f(x, y); `transformed` positions it elsewhere.
class SurfaceMirror final : public Mirror {
 public:
  SurfaceMirror(const Surface& surface, Mapping mapping);
  /// Placed: x -> scale * rotation * x + translation from its own frame.
  /// Throws InvalidInput unless scale > 0 and rotation is orthonormal.
  SurfaceMirror(const Surface& surface, Mapping mapping, double scale, const Matrix3& rotation,
                const Vector3& translation);

  const Surface& surface() const { return surface_; }
  Mapping mapping() const { return mapping_; }
  /// The direction of mapping of a fixed one: the surface's z axis where it stands.
  Vector3 direction() const { return placed_.rotation.col(2); }
  Vector3 direction(const Foot& foot) const override {
    return mapping_ == Mapping::Fixed ? direction() : foot.normal;
  }

  /// The point of the graph closest to x, whatever the mapping: the nearest minimum to the best of
  /// a grid of starts, to rounding.
  Vector3 closest(const Vector3& x) const;

  /// x in the surface's frame, where the surface is z = f(x, y).
  Vector3 to_frame(const Vector3& x) const {
    return placed_.rotation.transpose() * (x - placed_.translation) / placed_.scale;
  }
  /// Input units a unit of that frame.
  double scale() const { return placed_.scale; }

  std::string_view kind() const override { return "surface"; }
  std::optional<Foot> at(const Vector3& x) const override;
  /// "surface", "mapping", "scale", "rotation" (3 x 3) and "translation".
  Values numbers() const override;

 private:
  Matrix3 shape_operator(const Foot& foot) const override;
  std::unique_ptr<Mirror> moved(const Motion& by) const override;
  Mesh mesh_over(const std::vector<Foot>& feet, int resolution,
                 const Context& context) const override;

  const Surface& surface_;
  Mapping mapping_;
  Motion placed_;  // from its own frame
};

class HeightInterpolant;

/// A curved mirror with a fixed direction of mapping v: the graph of a height h over the plane
/// orthogonal to v. A point is mapped along v: x' = x + 2 (h - x . v) v.
///
/// The surface passes through given nodes: quadratics fitted about each, blended by inverse
/// distance over the nearest ones (modified quadratic Shepard: Franke and Nielson 1980, Renka
/// 1988). It is defined everywhere: in gaps between the nodes and beyond them each quadratic is
/// continued by its tangent, so it stays smooth and grows linearly. Direction and nodes are all
/// there is to it: the same numbers make the same mirror.
class HeightField final : public Mirror {
 public:
  /// The direction may have any length but zero. Nodes: m x 3, one at least, in input units; of
  /// nodes that lie over each other along the direction only the first counts.
  /// Throws InvalidInput for a zero or non-finite direction and for no or non-finite nodes,
  /// Cancelled.
  HeightField(const Vector3& direction, Points nodes, const Context& context = {});

  const Vector3& direction() const { return direction_; }
  Vector3 direction(const Foot&) const override { return direction_; }
  const Points& nodes() const { return *nodes_; }

  std::string_view kind() const override { return "height field"; }
  std::optional<Foot> at(const Vector3& x) const override;
  /// The unit normal at the foot of x, on the side that the direction points to.
  Vector3 normal(const Vector3& x) const;
  /// "direction", and "nodes" as m x 3.
  Values numbers() const override;

 private:
  std::unique_ptr<Mirror> moved(const Motion& by) const override;
  Mesh mesh_over(const std::vector<Foot>& feet, int resolution,
                 const Context& context) const override;

  Vector3 direction_;
  std::shared_ptr<const Points> nodes_;
  Vector3 origin_;                      // of the frame (across_, direction_)
  Eigen::Matrix<double, 3, 2> across_;  // orthonormal
  std::shared_ptr<const HeightInterpolant> heights_;
};

/// A quadratic piece of a surface: height z over the tangent coordinates (s, t) of its frame,
/// z = h0 + h1 s + h2 t + h3 s^2 + h4 s t + h5 t^2.
struct Patch {
  using Heights = Eigen::Matrix<double, 6, 1>;

  Vector3 centre;     ///< origin of the frame, on or near the surface
  Matrix3 frame;      ///< rows: two tangents and the normal, orthonormal
  Heights height;     ///< h0 .. h5
  double radius = 0;  ///< how far from the centre the piece has a say
};

/// A smooth surface of any shape, mirrored perpendicularly: the zero set of the blend of quadratic
/// patches with weights (1 - |x - centre|^2 / radius^2)^3 (a partition of unity: Ohtake et al.
/// 2003, "Multi-level partition of unity implicits"). Neighbouring patches must overlap and agree
/// about the side their normals point to. Points whose foot lies beyond the patches have none.
class FreeForm final : public Mirror {
 public:
  /// Throws InvalidInput without patches, for non-finite numbers, a radius that is not above 0 or a
  /// frame that is not orthonormal.
  explicit FreeForm(std::vector<Patch> patches);

  const std::vector<Patch>& patches() const;

  std::string_view kind() const override { return "free-form"; }
  std::optional<Foot> at(const Vector3& x) const override;
  /// "centres", "tangents", "normals" (k x 3 each), "heights" (k x 6) and "radii" (k x 1).
  Values numbers() const override;

  using Mirror::foot;
  /// The foot of x and the mirror's unit normal there, to a precision relative to the patches'
  /// size; false where x has no foot.
  bool foot(const Vector3& x, double precision, Vector3& foot, Vector3& normal) const;

 private:
  struct Blend;

  Matrix3 shape_operator(const Foot& foot) const override;
  std::unique_ptr<Mirror> moved(const Motion& by) const override;
  Mesh mesh_over(const std::vector<Foot>& feet, int resolution,
                 const Context& context) const override;

  std::shared_ptr<const Blend> blend_;
};

/// The mirror that Mirror::kind() and Mirror::numbers() describe: how a mirror comes back from a
/// file or from a host's data. Numbers that do not belong to the kind are passed over.
/// Throws InvalidInput for an unknown kind, or a number that is missing, of another type or not
/// allowed; InvalidParameter for the name of a surface that there is not.
std::shared_ptr<Mirror> make_mirror(std::string_view kind, const Values& numbers);

/// The plane, or else the sphere, that all the points lie on: how a mirror comes back from its
/// triangles alone. `tolerance`: how far off a point may be, as a fraction of the points' own
/// diagonal. Null where they lie on neither, and where they all lie on one line.
/// Throws InvalidInput for non-finite points.
std::shared_ptr<Mirror> mirror_through(PointsView points, double tolerance = 1e-5);

enum class Bend {
  Straighten,  ///< carry points along while the mirror flattens into its plane
  Restore,     ///< the way back: bends what is symmetric about the plane
};

/// Carries points along with their mirror: each keeps its distance from the mirror and the
/// coordinates of its foot. A cylinder unrolls; other mirrors are laid out from the middle of their
/// footprint along the two directions they bend in most and least, true to length along the two
/// lines through the middle, so the mirror must be a graph over its tangent plane there. A shape
/// that the mirror reflects onto itself comes out symmetric about straight_mirror().
/// A mirror made by hand is laid out over the points' feet unless it was given a footprint; going
/// there and back needs the same footprint. Points beyond the mirror, which have no foot on it, go
/// rigidly with the nearest that has one; `unplaced`, where given, is set to their number,
/// `jacobians` to the derivatives of the map at the points. Rows that are not finite stay so.
/// Throws InvalidInput when no point of the footprint, or none of the points, has a foot or the
/// points extend over more than 1e50, Cancelled.
Points bend(PointsView points, const Mirror& mirror, Bend way = Bend::Straighten,
            const Context& context = {}, Index* unplaced = nullptr,
            std::vector<Matrix3>* jacobians = nullptr);

/// The plane that the mirror becomes: its tangent plane in the middle of its footprint.
/// `object` stands in for a mirror made by hand's missing footprint.
Plane straight_mirror(const Mirror& mirror, PointsView object = {});

/// Where a mirror reflects light of point sources to an eye: ordered by source, then by path
/// length.
struct ReflectionPoints {
  Points positions;                                 ///< m x 3, on the mirror
  Eigen::Matrix<Index, Eigen::Dynamic, 1> sources;  ///< of each the row of its source
  Eigen::VectorXd path_lengths;                     ///< |s - x| + |x - e|, input units
  /// At the eye, across the ray, of a source of unit intensity: per input unit squared. Infinite
  /// where the reflected light has its focus at the eye.
  Eigen::VectorXd irradiance;
};

/// All points x of the mirror at which light is reflected from a source s to the eye e: by Fermat's
/// principle those where the path length |s - x| + |x - e| is stationary on the mirror, s and e on
/// the same side of the tangent plane (Mitchell and Hanrahan 1992). Both sides of the mirror
/// reflect; that another part of it stands in the way is not looked at.
///
/// Planes, spheres and cylinders in closed form (Alhazen's problem: the real roots of a quartic),
/// quadrics by a search in one dimension (after Miguel et al.), other mirrors by Newton's steps
/// from a grid over their footprint, or over the nodes or patches of one made by hand. Where whole
/// curves reflect, as with both ends on a sphere's diameter, points in one plane through the ends
/// stand for them; where whole surfaces do, as with both ends in its centre, there are none. A
/// source or an eye on the mirror is reflected nowhere that it lies itself.
///
/// With the Hessian H of the path length in the tangent plane, d1 and d2 the lengths of its two
/// parts and t the angle of incidence, the irradiance is cos^2 t / (d1^2 d2^2 |det H|), which is
/// 1 / d1^2 times the ratio of the Gaussian curvatures that the reflected wavefront has at the eye
/// and at x (Mitchell and Hanrahan 1992). On a plane it is 1 / (d1 + d2)^2.
///
/// Throws InvalidInput for a source or an eye that is not finite, and for a surface mirror made by
/// hand, which has no footprint; Cancelled.
ReflectionPoints reflection_points(const Mirror& mirror, PointsView sources, const Vector3& eye,
                                   const Context& context = {});

}  // namespace symsurf
