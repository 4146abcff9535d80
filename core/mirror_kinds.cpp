#include <symsurf/mirror.h>
#include <symsurf/mirrors.h>

#include <array>
#include <memory>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace symsurf {

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
    Kind{"oblique plane",
         [](const Values& v) { return made<ObliquePlane>(v, "normal", "offset", "direction"); }},
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
