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
void for_each(PointsView points, const Context& context, const Function& take) {
  parallel_for(context, points.size(), grain, [&](Index begin, Index end) {
    for (Index i = begin; i < end; ++i) take(i, points[i]);
  });
}

// Eigen compares matrices of one size only.
bool are_equal(const Value& a, const Value& b) {
  const auto* one = std::get_if<Eigen::MatrixXd>(&a);
  const auto* other = std::get_if<Eigen::MatrixXd>(&b);
  if (one && other && (one->rows() != other->rows() || one->cols() != other->cols())) return false;
  return a == b;
}

}  // namespace

Vector3 Mirror::foot(const Vector3& x) const {
  const std::optional<Foot> foot = at(x);
  return foot ? foot->point : Vector3::Constant(NAN);
}

double Mirror::signed_distance(const Vector3& x) const {
  const std::optional<Foot> foot = at(x);
  return foot ? foot->distance : NAN;
}

Vector3 Mirror::reflect(const Vector3& x) const {
  const std::optional<Foot> foot = at(x);
  return foot && has_image(*foot) ? Vector3(x + 2 * (foot->point - x)) : Vector3::Constant(NAN);
}

Points Mirror::reflect(PointsView points, const Context& context) const {
  Points images(points.size(), 3);
  for_each(points, context, [&](Index i, const Vector3& x) { images.row(i) = reflect(x); });
  return images;
}

Points Mirror::project(PointsView points, const Context& context) const {
  Points feet(points.size(), 3);
  for_each(points, context, [&](Index i, const Vector3& x) { feet.row(i) = foot(x); });
  return feet;
}

Eigen::VectorXd Mirror::signed_distance(PointsView points, const Context& context) const {
  Eigen::VectorXd distances(points.size());
  for_each(points, context, [&](Index i, const Vector3& x) { distances[i] = signed_distance(x); });
  return distances;
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
  std::vector<std::optional<Foot>> all(object.size());
  for_each(object, context.stage(0, 0.3), [&](Index i, const Vector3& x) { all[i] = at(x); });
  std::vector<Foot> feet;
  for (const std::optional<Foot>& foot : all)
    if (foot && foot->point.allFinite() && has_image(*foot)) feet.push_back(*foot);
  if (feet.empty())
    throw InvalidInput("none of the " + std::to_string(object.size()) +
                       " points of the object has an image over this " + std::string(kind()));
  Mesh mesh = mesh_over(feet, resolution, context.stage(0.3, 1));
  require_finite(mesh.vertices, "vertex of the mirror's mesh");
  return mesh;
}

namespace {

bool lie_on(const Mirror& mirror, PointsView points, double limit) {
  return (mirror.signed_distance(points).array().abs() <= limit).all();
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
  // In the frame, where the numbers are about 1.
  const Eigen::Vector4d round =
      sphere_through((points.matrix().rowwise() - frame.centroid.transpose()) / frame.size);
  if (!std::isfinite(round[3]) || !(round[3] > 0)) return nullptr;
  auto sphere = std::make_shared<Sphere>(frame.centroid + frame.size * round.head<3>(),
                                         frame.size * round[3]);
  return lie_on(*sphere, points, limit) ? sphere : nullptr;
}

namespace {

// A number of a mirror by its name, in the type that is asked for.
struct Given {
  const Values& numbers;
  const char* name;

  const Value& value() const {
    const auto it = numbers.find(name);
    if (it == numbers.end())
      throw InvalidInput(std::string("the mirror's ") + name + " is missing");
    return it->second;
  }

  [[noreturn]] void refuse(const Value& value, const std::string& needed) const {
    throw InvalidInput(std::string("the mirror's ") + name + " is " + to_string(value) + "; " +
                       needed);
  }

  template <typename T>
  const T& as(const char* needed) const {
    if (const auto* held = std::get_if<T>(&value())) return *held;
    refuse(value(), needed);
  }

  // Files and hosts hold whole numbers where there is no fraction.
  operator double() const {
    const auto* whole = std::get_if<Index>(&value());
    return whole ? static_cast<double>(*whole) : as<double>("a number is needed");
  }
  operator Vector3() const { return as<Vector3>("3 numbers are needed"); }
  operator Matrix3() const { return table(3, 3); }
  operator Points() const { return table(any, 3); }
  operator const Surface&() const { return surface(as<std::string>("a word is needed")); }
  operator Mapping() const {
    const auto& word = as<std::string>("a word is needed");
    if (word == "fixed") return Mapping::Fixed;
    if (word == "perpendicular") return Mapping::Perpendicular;
    refuse(word, "allowed is fixed | perpendicular");
  }

  static constexpr Index any = -1;

  // They hold a table of one row, or of one number, as a vector or as a number.
  Eigen::MatrixXd table(Index rows, Index columns) const {
    Eigen::MatrixXd values;
    if (const auto* matrix = std::get_if<Eigen::MatrixXd>(&value()))
      values = *matrix;
    else if (const auto* row = std::get_if<Vector3>(&value()))
      values = row->transpose();
    else
      values = Eigen::MatrixXd::Constant(1, 1, *this);
    if ((rows != any && values.rows() != rows) || values.cols() != columns)
      refuse(values, (rows == any ? "rows of " : std::to_string(rows) + " x ") +
                         std::to_string(columns) + " are needed");
    return values;
  }
};

template <typename Kind, typename... Names>
std::shared_ptr<Mirror> made(const Values& numbers, Names... names) {
  return std::make_shared<Kind>(Given{numbers, names}...);
}

std::shared_ptr<Mirror> free_form(const Values& numbers) {
  const auto rows = [&](const char* name, Index count, Index columns) {
    return Given{numbers, name}.table(count, columns);
  };
  const Points centres = Given{numbers, "centres"};
  const Index count = centres.rows();
  const Eigen::MatrixXd tangents = rows("tangents", count, 3), normals = rows("normals", count, 3),
                        heights = rows("heights", count, 6), radii = rows("radii", count, 1);
  std::vector<Patch> patches(count);
  for (Index i = 0; i < count; ++i) {
    const Vector3 tangent = tangents.row(i), normal = normals.row(i);
    Patch& patch = patches[i];
    patch.centre = centres.row(i);
    patch.frame << tangent, normal.cross(tangent), normal;
    patch.frame.transposeInPlace();
    patch.height = heights.row(i);
    patch.radius = radii(i, 0);
  }
  return std::make_shared<FreeForm>(std::move(patches));
}

struct Kind {
  std::string_view name;
  std::shared_ptr<Mirror> (*make)(const Values&);
};

const std::array kinds{
    Kind{"plane", [](const Values& v) { return made<Plane>(v, "normal", "offset"); }},
    Kind{"sphere", [](const Values& v) { return made<Sphere>(v, "centre", "radius"); }},
    Kind{"cylinder", [](const Values& v) { return made<Cylinder>(v, "point", "axis", "radius"); }},
    Kind{"quadric",
         [](const Values& v) {
           return v.contains("origin") ? made<Quadric>(v, "matrix", "origin", "gradient", "value")
                                       : made<Quadric>(v, "matrix", "linear", "constant");
         }},
    Kind{"free-form", free_form},
    Kind{"height field",
         [](const Values& v) { return made<HeightField>(v, "direction", "nodes"); }},
    Kind{"surface",
         [](const Values& v) {
           return made<SurfaceMirror>(v, "surface", "mapping", "scale", "rotation", "translation");
         }},
};

}  // namespace

std::shared_ptr<Mirror> make_mirror(std::string_view kind, const Values& numbers) {
  std::string names;
  for (const auto& [name, make] : kinds) {
    if (name == kind) return make(numbers);
    names += (names.empty() ? "" : ", ") + std::string(name);
  }
  throw InvalidInput("there is no mirror of the kind '" + std::string(kind) + "'; there are " +
                     names);
}

}  // namespace symsurf
