#include <pybind11/numpy.h>
#include <pybind11/stl.h>
#include <symsurf/mirrors.h>
#include <symsurf/synthetic.h>

#include <optional>
#include <string>
#include <utility>

#include "arrays.h"
#include "bindings.h"
#include "context.h"
#include "values.h"

namespace symsurf::python {

namespace {

using BoxArgument = std::optional<std::pair<VectorArgument, VectorArgument>>;
using Doubles = py::array_t<double, py::array::c_style | py::array::forcecast>;

Box box_from(const BoxArgument& box) {
  return box ? Box{box->first.vector, box->second.vector} : Box{};
}

py::object height(const std::string& name, const Doubles& x, const Doubles& y) {
  const Surface& f = surface(name);
  return py::vectorize([&f](double a, double b) { return f(a, b); })(x, y);
}

py::tuple gradient(const std::string& name, const Doubles& x, const Doubles& y) {
  const Surface& f = surface(name);
  return py::make_tuple(
      py::vectorize([&f](double a, double b) { return f.gradient(a, b).x(); })(x, y),
      py::vectorize([&f](double a, double b) { return f.gradient(a, b).y(); })(x, y));
}

// (points, truth, pairs, skipped), for symsurf.synthetic.Sample.
py::tuple to_tuple(Sample sample) {
  return py::make_tuple(owned_array(std::move(sample.points)),
                        std::const_pointer_cast<Mirror>(sample.truth),
                        owned_array(std::move(sample.pairs)), sample.skipped);
}

const Generator& generator(const std::string& name) {
  for (const Generator& candidate : generators())
    if (candidate.name == name) return candidate;
  generate(name);  // says what there is
  throw py::key_error(name);
}

const Damage& kind_of_damage(const std::string& name) {
  for (const Damage& candidate : damages())
    if (candidate.name == name) return candidate;
  damage(name, {});
  throw py::key_error(name);
}

template <typename Description>
py::class_<Description> bind_description(py::module_& module, const char* name, const char* doc) {
  py::class_<Description> description(module, name, doc);
  description.def_readonly("name", &Description::name)
      .def_readonly("title", &Description::title, "For menus.")
      .def_readonly("summary", &Description::summary, "One sentence.")
      .def_readonly("parameters", &Description::parameters);
  return description;
}

template <typename Description>
py::typing::Dict<py::str, Description> by_name(const std::vector<Description>& list) {
  py::typing::Dict<py::str, Description> found;
  for (const Description& item : list)
    found[py::str(item.name)] = py::cast(item, py::return_value_policy::reference);
  return found;
}

void bind_generators(py::module_& module) {
  bind_description<Generator>(module, "Generator", "The description of a generator of samples.")
      .def_readonly("mirrors_points", &Generator::mirrors_points,
                    "Whether it mirrors given points.");
  module.def(
      "generators", [] { return by_name(generators()); }, "All generators by name.");
  module.def(
      "generate",
      [](const std::string& name, const py::dict& parameters,
         const std::optional<PointsArgument>& points) {
        const Values values = values_from(parameters, generator(name).parameters);
        return to_tuple(without_gil(
            [&] { return generate(name, values, points ? PointsView(*points) : PointsView()); }));
      },
      py::arg("name"), py::arg("parameters"), py::arg("points"));
  module.def("mirror_fixed", [](const PointsArgument& points, const std::string& name, double shift,
                                const VectorArgument& direction) {
    return to_tuple(
        without_gil([&] { return mirror_fixed(points, surface(name), shift, direction.vector); }));
  });
  module.def("mirror_perpendicular", [](const std::string& name, double extent, Index resolution,
                                        double min_distance, double max_distance, Index waves) {
    return to_tuple(without_gil([&] {
      return mirror_perpendicular(surface(name), extent, resolution, min_distance, max_distance,
                                  waves);
    }));
  });
  module.def("mirror_spherical",
             [](const PointsArgument& points, const VectorArgument& centre, double radius) {
               return to_tuple(without_gil(
                   [&] { return mirror_spherical(points, Sphere(centre.vector, radius)); }));
             });
  module.def("sphere_between",
             [](const VectorArgument& first, const VectorArgument& second, double radius) {
               return std::make_shared<Sphere>(sphere_between(first.vector, second.vector, radius));
             });
}

void bind_damages(py::module_& module) {
  bind_description<Damage>(module, "Damage", "The description of a kind of damage.");
  module.def(
      "damages", [] { return by_name(damages()); }, "All kinds of damage by name.");
  module.def(
      "damage",
      [](const std::string& name, const PointsArgument& points, const py::dict& parameters,
         const py::object& seed) {
        const Values values = values_from(parameters, kind_of_damage(name).parameters);
        const std::uint64_t drawn = seed_from(seed);
        Damaged damaged = without_gil([&] { return damage(name, points, values, drawn); });
        return py::make_tuple(owned_array(std::move(damaged.points)), damaged.kept);
      },
      py::arg("name"), py::arg("points"), py::arg("parameters"), py::arg("seed"));
  module.def("add_noise", [](const PointsArgument& points, double low, double high,
                             const BoxArgument& box, const py::object& seed) {
    return owned_array(add_noise(points, low, high, box_from(box), seed_from(seed)));
  });
  module.def("remove_points", [](const PointsArgument& points, double probability,
                                 const BoxArgument& box, const py::object& seed) {
    return owned_array(remove_points(points, probability, box_from(box), seed_from(seed)).points);
  });
  module.def("rotate", [](const PointsArgument& points, double roll, double pitch, double yaw) {
    return owned_array(rotate(points, roll, pitch, yaw));
  });
  module.def("rotation_matrix", [](double roll, double pitch, double yaw) {
    return owned_array(
        Eigen::Matrix<double, 3, 3, Eigen::RowMajor>(rotation_matrix(roll, pitch, yaw)));
  });
  module.def("thin", [](const PointsArgument& points, double ratio, const VectorArgument& direction,
                        const py::object& seed) {
    return owned_array(thin(points, ratio, direction.vector, seed_from(seed)).points);
  });
}

}  // namespace

void bind_synthesis(py::module_& module) {
  module.def("surface_names", &surface_names);
  module.def("surface_formula", [](const std::string& name) { return surface(name).formula; });
  module.def("surface_height", &height);
  module.def("surface_gradient", &gradient);
  module.def("sampled_surface", [](const std::string& name, double extent, Index resolution) {
    return owned_array(
        without_gil([&] { return sampled_surface(surface(name), extent, resolution); }));
  });
  bind_generators(module);
  bind_damages(module);
}

}  // namespace symsurf::python
