#include <symsurf/context.h>
#include <symsurf/mirrors.h>

#include <array>
#include <cmath>

#include "base/linear_algebra.h"
#include "base/math.h"
#include "operations/counterparts.h"
#include "operations/operation.h"

namespace symsurf {

namespace {

// Right-handed coordinates in which people want their objects: where left and right, up and front
// lie.
struct Frame {
  const char* name;
  Vector3 lateral, up, front;
};

const std::array<Frame, 4> frames{{
    {"ras", Vector3::UnitX(), Vector3::UnitZ(), Vector3::UnitY()},   // NIfTI, 3D Slicer
    {"lps", Vector3::UnitX(), Vector3::UnitZ(), -Vector3::UnitY()},  // DICOM, ITK
    {"blender", Vector3::UnitX(), Vector3::UnitZ(), -Vector3::UnitY()},
    {"cfd", Vector3::UnitY(), Vector3::UnitZ(), -Vector3::UnitX()},  // the flow runs along x
}};

// Normal and a point on it, of a mirror that bends the plane nearest to the points' feet.
struct MidPlane {
  Vector3 normal, point;
};

MidPlane mid_plane(PointsView points, const Mirror& mirror, const Context& context) {
  const Vector3 centroid = points.matrix().colwise().mean().transpose();
  if (mirror.kind() == "plane") {
    const Foot foot = *mirror.at(centroid);
    return {foot.normal, foot.point};
  }
  const Points feet = finite_rows(mirror.project(points, context));
  if (feet.rows() < 3) throw InvalidInput("fewer than three points have a foot on the mirror");
  const Vector3 middle = feet.colwise().mean().transpose();
  const Vector3 normal = eigen_of_scatter(feet.rowwise() - middle.transpose()).vectors.col(0);
  return {normal, centroid - normal.dot(centroid - middle) * normal};
}

// The rotation with R lateral = its axis and R up = its own; both given orthogonal, of length 1.
Matrix3 rotation_of(const Vector3& lateral, const Vector3& up, const Vector3& lateral_axis,
                    const Vector3& up_axis) {
  Matrix3 from, to;
  from << lateral, up, lateral.cross(up);
  to << lateral_axis, up_axis, lateral_axis.cross(up_axis);
  return to * from.transpose();
}

// Of two ways to lay an object, the lesser turn: the greater trace.
Matrix3 lesser_turn(const Matrix3& a, const Matrix3& b) { return a.trace() >= b.trace() ? a : b; }

Vector3 in_plane(const Vector3& direction, const Vector3& normal, const char* name) {
  const Vector3 along = direction - direction.dot(normal) * normal;
  if (along.norm() <= 1e-6 * direction.norm())
    throw InvalidParameter(std::string(name) + " is " + to_string(Value(direction)) +
                           ", across the mirror; allowed is a direction along it");
  return along.normalized();
}

// The direction along the mirror that the points extend most in.
Vector3 longest_along(PointsView points, const MidPlane& plane) {
  Points flat(points.size(), 3);
  const Vector3 middle = points.matrix().colwise().mean().transpose();
  for (Index i = 0; i < points.size(); ++i) {
    const Vector3 x = points[i] - middle;
    flat.row(i) = (x - x.dot(plane.normal) * plane.normal).transpose();
  }
  return in_plane(eigen_of_scatter(flat).vectors.col(2), plane.normal, "the longest direction");
}

Matrix3 turned(PointsView points, const MidPlane& plane, const ParameterValues& values) {
  Frame target{"", Vector3::Zero(), Vector3::Zero(), Vector3::Zero()};
  const std::string& axis = values.choice("axis");
  const int lateral = axis[0] - 'x';
  target.lateral = Vector3::Unit(lateral);
  target.up = Vector3::Unit(lateral == 2 ? 1 : 2);
  target.front = -Vector3::Unit(lateral == 0 ? 1 : 0);
  const std::string& name = values.choice("frame");
  for (const Frame& frame : frames)
    if (name == frame.name) target = frame;

  const Vector3 &n = plane.normal, up = values.vector("up"), front = values.vector("front");
  const auto both_ways = [&](const Vector3& along, const Vector3& axis) {
    return lesser_turn(rotation_of(n, along, target.lateral, axis),
                       rotation_of(-n, along, target.lateral, axis));
  };
  if (!up.isZero(0) && !front.isZero(0)) {
    const Vector3 upwards = in_plane(up, n, "up");
    const Vector3 forwards = front - front.dot(upwards) * upwards;
    const Matrix3 one = rotation_of(n, upwards, target.lateral, target.up);
    const Matrix3 other = rotation_of(-n, upwards, target.lateral, target.up);
    return (one * forwards).dot(target.front) >= (other * forwards).dot(target.front) ? one : other;
  }
  if (!up.isZero(0)) return both_ways(in_plane(up, n, "up"), target.up);
  if (!front.isZero(0)) return both_ways(in_plane(front, n, "front"), target.front);
  if (name == "principal") {
    const Vector3 along = longest_along(points, plane);
    return lesser_turn(both_ways(along, target.up), both_ways(-along, target.up));
  }
  const Vector3 nearer = n.dot(target.lateral) < 0 ? Vector3(-n) : n;
  return least_rotation(nearer, target.lateral);
}

void run_align(const OperationInput& input, const Mirror& mirror, const ParameterValues& values,
               const Context& context, OperationResult& result) {
  const MidPlane plane = mid_plane(input.points, mirror, context);
  const Matrix3 rotation = turned(input.points, plane, values);
  Eigen::MatrixXd matrix = Matrix4::Identity();
  matrix.topLeftCorner<3, 3>() = rotation;
  matrix.topRightCorner<3, 1>() = -rotation * plane.point;
  for (Index i = 0; i < input.points.size(); ++i)
    result.points.row(i) = (rotation * (input.points[i] - plane.point)).transpose();
  result.statistics["matrix"] = matrix;
}

}  // namespace

OperationImplementation align_operation() {
  OperationImplementation operation;
  operation.name = "align";
  operation.title = "Mirror alignment";
  operation.summary =
      "Moves the shape rigidly so that its mirror plane, or the plane closest to a curved mirror, "
      "becomes a coordinate plane through the origin.";
  operation.parameters = {
      Parameter::choice("axis", "x", {"x", "y", "z"},
                        "Coordinate axis normal to the mirror after the move; the frames of other "
                        "programs have their own."),
      Parameter::choice("frame", "least", {"least", "principal", "ras", "lps", "blender", "cfd"},
                        "Rotation about that axis: least rotates as little as possible, principal "
                        "puts the longest extent upright, the others are the coordinate systems of "
                        "NIfTI, DICOM, Blender and flow along x, oriented by up and front."),
      Parameter::direction(
          "up", "Direction in the input that will point up: along z, or along y if axis is z."),
      Parameter::direction("front", "Direction in the input that will point to the front."),
  };
  operation.moves_points = true;
  operation.run = run_align;
  return operation;
}

namespace {

// The shear that makes an oblique plane's direction its normal: x + h (n - d / (n . d)), h the
// height over the plane; the way back subtracts what h is multiplied by.
Eigen::MatrixXd upright(const Mirror& plane, bool back) {
  const Foot origin = *plane.at(Vector3::Zero());
  const Vector3 &n = origin.normal, d = plane.direction(origin);
  const Vector3 shift = (back ? -1 : 1) * (n - d / n.dot(d));
  Eigen::MatrixXd matrix = Matrix4::Identity();
  matrix.topLeftCorner<3, 3>() += shift * n.transpose();
  matrix.topRightCorner<3, 1>() = origin.distance * n.dot(d) * shift;
  return matrix;
}

void run_straighten(const OperationInput& input, const Mirror& mirror,
                    const ParameterValues& values, const Context& context,
                    OperationResult& result) {
  const bool back = values.boolean("back");
  Index unplaced = 0;
  result.points =
      bend(input.points, mirror, back ? Bend::Restore : Bend::Straighten, context, &unplaced);
  const Plane plane = straight_mirror(mirror, input.points);
  result.statistics["normal"] = plane.normal();
  result.statistics["offset"] = plane.offset();
  result.statistics["unplaced_points"] = unplaced;
  if (mirror.kind() == "oblique plane") result.statistics["matrix"] = upright(mirror, back);
}

}  // namespace

OperationImplementation straighten_operation() {
  OperationImplementation operation;
  operation.name = "straighten";
  operation.title = "Mirror straightening";
  operation.summary =
      "Flattens a curved mirror and the shape with it, or reverses that: each point keeps its foot "
      "point and its distance from the mirror.";
  operation.parameters = {Parameter::boolean(
      "back", false, "Reverse: bends a straightened shape over the same mirror.")};
  operation.moves_points = true;
  operation.run = run_straighten;
  return operation;
}

}  // namespace symsurf
