#include <symsurf/cylinder.h>
#include <symsurf/errors.h>
#include <symsurf/free_form.h>
#include <symsurf/height_field.h>
#include <symsurf/make_mirror.h>
#include <symsurf/plane.h>
#include <symsurf/quadric.h>
#include <symsurf/sphere.h>
#include <symsurf/surface_mirror.h>

#include <Eigen/Geometry>
#include <array>
#include <string>
#include <vector>

namespace symsurf {

namespace {

template <typename T>
const T& number(const Values& numbers, const char* name) {
  const auto it = numbers.find(name);
  const T* value = it == numbers.end() ? nullptr : std::get_if<T>(&it->second);
  if (!value)
    throw InvalidInput(std::string("the mirror's ") + name + " is " +
                       (it == numbers.end() ? "missing" : "'" + to_string(it->second) + "'"));
  return *value;
}

const Eigen::MatrixXd& table(const Values& numbers, const char* name, Index rows, Index columns) {
  const auto& values = number<Eigen::MatrixXd>(numbers, name);
  if (values.rows() != rows || values.cols() != columns)
    throw InvalidInput(std::string("the mirror's ") + name + " are " +
                       std::to_string(values.rows()) + " x " + std::to_string(values.cols()) +
                       " numbers; " + std::to_string(rows) + " x " + std::to_string(columns) +
                       " are needed");
  return values;
}

std::shared_ptr<Mirror> free_form(const Values& numbers) {
  const auto& centres = number<Eigen::MatrixXd>(numbers, "centres");
  const Index count = centres.rows();
  table(numbers, "centres", count, 3);
  const auto& tangents = table(numbers, "tangents", count, 3);
  const auto& normals = table(numbers, "normals", count, 3);
  const auto& heights = table(numbers, "heights", count, 6);
  const auto& radii = table(numbers, "radii", count, 1);
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

struct Kind {
  std::string_view name;
  std::shared_ptr<Mirror> (*make)(const Values&);
};

const std::array kinds{
    Kind{"plane",
         [](const Values& v) -> std::shared_ptr<Mirror> {
           return std::make_shared<Plane>(number<Vector3>(v, "normal"),
                                          number<double>(v, "offset"));
         }},
    Kind{"sphere",
         [](const Values& v) -> std::shared_ptr<Mirror> {
           return std::make_shared<Sphere>(number<Vector3>(v, "centre"),
                                           number<double>(v, "radius"));
         }},
    Kind{"cylinder",
         [](const Values& v) -> std::shared_ptr<Mirror> {
           return std::make_shared<Cylinder>(number<Vector3>(v, "point"),
                                             number<Vector3>(v, "axis"),
                                             number<double>(v, "radius"));
         }},
    Kind{"quadric",
         [](const Values& v) -> std::shared_ptr<Mirror> {
           return std::make_shared<Quadric>(table(v, "matrix", 3, 3), number<Vector3>(v, "linear"),
                                            number<double>(v, "constant"));
         }},
    Kind{"free-form", free_form},
    Kind{"height field",
         [](const Values& v) -> std::shared_ptr<Mirror> {
           return std::make_shared<HeightField>(number<Vector3>(v, "direction"),
                                                Points(number<Eigen::MatrixXd>(v, "nodes")));
         }},
    Kind{"surface",
         [](const Values& v) -> std::shared_ptr<Mirror> {
           const auto mapping = number<std::string>(v, "mapping") == "fixed"
                                    ? Mapping::Fixed
                                    : Mapping::Perpendicular;
           return std::make_shared<SurfaceMirror>(
               surface(number<std::string>(v, "surface")), mapping, number<double>(v, "scale"),
               Matrix3(table(v, "rotation", 3, 3)), number<Vector3>(v, "translation"));
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
