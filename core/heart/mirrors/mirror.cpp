#include <symsurf/context.h>
#include <symsurf/mirror.h>
#include <symsurf/mirrors.h>

#include <Eigen/Dense>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <variant>
#include <vector>

#include "base/linear_algebra.h"
#include "base/parallel.h"
#include "cloud/cloud.h"
#include "cloud/principal_frame.h"

namespace symsurf {

namespace {

// A foot of a free-form mirror takes some ten microseconds.
constexpr Index grain = 1024;

// Cells along the longer side of a mesh, which holds their square: some gigabytes.
constexpr int finest = 4096;

template <typename Function>
Points each(PointsView points, const Context& context, const Function& function) {
  Points out(points.size(), 3);
  parallel_for(context, points.size(), grain, [&](Index begin, Index end) {
    for (Index i = begin; i < end; ++i) out.row(i) = function(points[i]).transpose();
  });
  return out;
}

// Eigen compares matrices of one size only.
bool are_equal(const Value& a, const Value& b) {
  const auto* one = std::get_if<Eigen::MatrixXd>(&a);
  const auto* other = std::get_if<Eigen::MatrixXd>(&b);
  if (one && other && (one->rows() != other->rows() || one->cols() != other->cols())) return false;
  return a == b;
}

}  // namespace

Vector3 Mirror::no_point() { return Vector3::Constant(std::numeric_limits<double>::quiet_NaN()); }

Vector3 Mirror::reflect(const Vector3& x) const {
  return has_image(x) ? Vector3(x + 2 * (foot(x) - x)) : no_point();
}

Points Mirror::reflect(PointsView points, const Context& context) const {
  return each(points, context, [this](const Vector3& x) { return reflect(x); });
}

Points Mirror::project(PointsView points, const Context& context) const {
  return each(points, context, [this](const Vector3& x) { return foot(x); });
}

Eigen::VectorXd Mirror::signed_distance(PointsView points, const Context& context) const {
  Eigen::VectorXd out(points.size());
  parallel_for(context, points.size(), grain, [&](Index begin, Index end) {
    for (Index i = begin; i < end; ++i) out[i] = signed_distance(points[i]);
  });
  return out;
}

bool Mirror::operator==(const Mirror& other) const {
  if (kind() != other.kind()) return false;
  const Values own = numbers(), others = other.numbers();
  return std::equal(own.begin(), own.end(), others.begin(), others.end(),
                    [](const auto& a, const auto& b) {
                      return a.first == b.first && are_equal(a.second, b.second);
                    });
}

Mesh Mirror::mesh(PointsView object, int resolution, const Context& context) const {
  if (object.empty())
    throw InvalidInput(
        "there are no points to lay the mesh over: a mirror made by hand has no "
        "footprint of its own, give the points of the object");
  require_finite(object, "point");
  require_extent(object, "points");
  if (resolution < 1 || resolution > finest)
    throw InvalidParameter("resolution is " + std::to_string(resolution) + "; allowed is 1 to " +
                           std::to_string(finest));
  Mesh mesh = mesh_over(object, resolution, context);
  require_finite(mesh.vertices, "vertex of the mirror's mesh");
  return mesh;
}

namespace {

bool lie_on(const Mirror& mirror, PointsView points, double limit) {
  return (mirror.signed_distance(points).array().abs() <= limit).all();
}

// |x|^2 = 2 c . x + d by least squares, in the frame, where the numbers are about 1.
std::shared_ptr<Mirror> fitted_sphere(PointsView points, const PrincipalFrame& frame) {
  Eigen::Matrix4d normal = Eigen::Matrix4d::Zero();
  Eigen::Vector4d right = Eigen::Vector4d::Zero();
  for (Index i = 0; i < points.size(); ++i) {
    const Vector3 x = frame.to_frame(points[i]);
    const Eigen::Vector4d row(2 * x.x(), 2 * x.y(), 2 * x.z(), 1);
    normal += row * row.transpose();
    right += x.squaredNorm() * row;
  }
  const Eigen::Vector4d solution = solved(normal, right);
  const Vector3 centre = solution.head<3>();
  const double radius = std::sqrt(solution[3] + centre.squaredNorm());
  if (!std::isfinite(radius) || !(radius > 0)) return nullptr;
  return std::make_shared<Sphere>(frame.from_frame(centre), frame.size * radius);
}

}  // namespace

std::shared_ptr<Mirror> mirror_through(PointsView points, double tolerance) {
  if (!points.matrix().allFinite()) throw InvalidInput("the points of a mirror must be finite");
  if (points.size() < 3) return nullptr;
  const PrincipalFrame frame = principal_frame(points, Context());
  const double limit = tolerance * frame.size;
  if (!(std::sqrt(frame.variance[1]) > limit)) return nullptr;
  const Vector3 normal = frame.axes.col(2);
  auto plane = std::make_shared<Plane>(normal, -normal.dot(frame.centroid));
  if (lie_on(*plane, points, limit)) return plane;
  auto sphere = fitted_sphere(points, frame);
  return sphere && lie_on(*sphere, points, limit) ? sphere : nullptr;
}

namespace {

const Value& given(const Values& numbers, const char* name) {
  const auto it = numbers.find(name);
  if (it == numbers.end()) throw InvalidInput(std::string("the mirror's ") + name + " is missing");
  return it->second;
}

[[noreturn]] void refuse(const char* name, const Value& value, const std::string& needed) {
  throw InvalidInput(std::string("the mirror's ") + name + " is " + to_string(value) + "; " +
                     needed);
}

// Files and hosts hold whole numbers where there is no fraction.
double scalar(const Values& numbers, const char* name) {
  const Value& value = given(numbers, name);
  if (const auto* real = std::get_if<double>(&value)) return *real;
  if (const auto* whole = std::get_if<Index>(&value)) return static_cast<double>(*whole);
  refuse(name, value, "a number is needed");
}

Vector3 vector(const Values& numbers, const char* name) {
  const Value& value = given(numbers, name);
  if (const auto* three = std::get_if<Vector3>(&value)) return *three;
  refuse(name, value, "3 numbers are needed");
}

const std::string& word(const Values& numbers, const char* name) {
  const Value& value = given(numbers, name);
  if (const auto* text = std::get_if<std::string>(&value)) return *text;
  refuse(name, value, "a word is needed");
}

constexpr Index any = -1;

// They hold a table of one row, or of one number, as a vector or as a number.
Eigen::MatrixXd table(const Values& numbers, const char* name, Index rows, Index columns) {
  const Value& value = given(numbers, name);
  const auto* matrix = std::get_if<Eigen::MatrixXd>(&value);
  const auto* row = std::get_if<Vector3>(&value);
  Eigen::MatrixXd values;
  if (matrix)
    values = *matrix;
  else if (row)
    values = row->transpose();
  else
    values = Eigen::MatrixXd::Constant(1, 1, scalar(numbers, name));
  if ((rows != any && values.rows() != rows) || values.cols() != columns)
    refuse(name, values,
           (rows == any ? "rows of " : std::to_string(rows) + " x ") + std::to_string(columns) +
               " are needed");
  return values;
}

Mapping mapping(const Values& numbers) {
  const std::string& name = word(numbers, "mapping");
  if (name == "fixed") return Mapping::Fixed;
  if (name == "perpendicular") return Mapping::Perpendicular;
  refuse("mapping", name, "allowed is fixed | perpendicular");
}

std::shared_ptr<Mirror> free_form(const Values& numbers) {
  const Eigen::MatrixXd centres = table(numbers, "centres", any, 3);
  const Index count = centres.rows();
  const Eigen::MatrixXd tangents = table(numbers, "tangents", count, 3);
  const Eigen::MatrixXd normals = table(numbers, "normals", count, 3);
  const Eigen::MatrixXd heights = table(numbers, "heights", count, 6);
  const Eigen::MatrixXd radii = table(numbers, "radii", count, 1);
  std::vector<Patch> patches(count);
  for (Index i = 0; i < count; ++i) {
    const Vector3 tangent = tangents.row(i), normal = normals.row(i);
    patches[i].centre = centres.row(i);
    patches[i].frame.row(0) = tangent.transpose();
    patches[i].frame.row(1) = normal.cross(tangent).transpose();
    patches[i].frame.row(2) = normal.transpose();
    patches[i].height = heights.row(i);
    patches[i].radius = radii(i, 0);
  }
  return std::make_shared<FreeForm>(std::move(patches));
}

std::shared_ptr<Mirror> quadric(const Values& numbers) {
  const Matrix3 matrix = table(numbers, "matrix", 3, 3);
  if (numbers.contains("origin"))
    return std::make_shared<Quadric>(matrix, vector(numbers, "origin"), vector(numbers, "gradient"),
                                     scalar(numbers, "value"));
  return std::make_shared<Quadric>(matrix, vector(numbers, "linear"), scalar(numbers, "constant"));
}

struct Kind {
  std::string_view name;
  std::shared_ptr<Mirror> (*make)(const Values&);
};

const std::array kinds{
    Kind{"plane",
         [](const Values& v) -> std::shared_ptr<Mirror> {
           return std::make_shared<Plane>(vector(v, "normal"), scalar(v, "offset"));
         }},
    Kind{"sphere",
         [](const Values& v) -> std::shared_ptr<Mirror> {
           return std::make_shared<Sphere>(vector(v, "centre"), scalar(v, "radius"));
         }},
    Kind{"cylinder",
         [](const Values& v) -> std::shared_ptr<Mirror> {
           return std::make_shared<Cylinder>(vector(v, "point"), vector(v, "axis"),
                                             scalar(v, "radius"));
         }},
    Kind{"quadric", quadric},
    Kind{"free-form", free_form},
    Kind{"height field",
         [](const Values& v) -> std::shared_ptr<Mirror> {
           return std::make_shared<HeightField>(vector(v, "direction"),
                                                Points(table(v, "nodes", any, 3)));
         }},
    Kind{"surface",
         [](const Values& v) -> std::shared_ptr<Mirror> {
           return std::make_shared<SurfaceMirror>(
               surface(word(v, "surface")), mapping(v), scalar(v, "scale"),
               Matrix3(table(v, "rotation", 3, 3)), vector(v, "translation"));
         }},
};

}  // namespace

std::shared_ptr<Mirror> make_mirror(std::string_view kind, const Values& numbers) {
  std::string names;
  for (const Kind& known : kinds) {
    if (known.name == kind) return known.make(numbers);
    names += (names.empty() ? "" : ", ") + std::string(known.name);
  }
  throw InvalidInput("there is no mirror of the kind '" + std::string(kind) + "'; there are " +
                     names);
}

}  // namespace symsurf
