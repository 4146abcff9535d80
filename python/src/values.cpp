#include "values.h"

#include <pybind11/eigen.h>
#include <pybind11/stl.h>
#include <symsurf/context.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "arrays.h"

namespace symsurf::python {

namespace {

std::string shown(py::handle object) { return py::repr(object).cast<std::string>(); }

std::optional<Value> numbers_from(py::handle object) {
  try {
    const auto array =
        py::array_t<double, py::array::c_style | py::array::forcecast>::ensure(object);
    if (array && array.ndim() == 1 && array.size() == 3)
      return Vector3(array.at(0), array.at(1), array.at(2));
    if (array && array.ndim() == 2) return py::cast<Eigen::MatrixXd>(array);
  } catch (py::error_already_set&) {
  }
  return std::nullopt;
}

std::optional<Value> value_from(py::handle object) {
  bool truth;
  py::detail::make_caster<bool> boolean;  // without conversion: bool and numpy.bool only
  if (boolean.load(object, false)) {
    truth = boolean;
    return truth;
  }
  if (PyIndex_Check(object.ptr())) {
    const auto whole = py::reinterpret_steal<py::object>(PyNumber_Index(object.ptr()));
    if (!whole) {
      PyErr_Clear();
      return numbers_from(object);
    }
    int overflow = 0;
    const long long number = PyLong_AsLongLongAndOverflow(whole.ptr(), &overflow);
    if (overflow == 0) return static_cast<Index>(number);
    if (const double real = PyLong_AsDouble(whole.ptr()); !PyErr_Occurred()) return real;
    PyErr_Clear();
    return std::copysign(std::numeric_limits<double>::infinity(), overflow);
  }
  if (PyFloat_Check(object.ptr())) return PyFloat_AsDouble(object.ptr());
  if (py::isinstance<py::str>(object)) return object.cast<std::string>();
  if (object.is_none()) return std::nullopt;
  if (const auto numbers = numbers_from(object)) return numbers;
  const double real = PyFloat_AsDouble(object.ptr());  // numpy.float32, Fraction, ...
  if (!PyErr_Occurred()) return real;
  PyErr_Clear();
  return std::nullopt;
}

}  // namespace

py::object to_python(const Value& value) {
  struct Conversion {
    py::object operator()(bool v) const { return py::bool_(v); }
    py::object operator()(Index v) const { return py::int_(v); }
    py::object operator()(double v) const { return py::float_(v); }
    py::object operator()(const std::string& v) const { return py::str(v); }
    py::object operator()(const Vector3& v) const { return owned_array(Vector3(v)); }
    py::object operator()(const Eigen::MatrixXd& v) const {
      using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
      return owned_array(RowMajor(v));
    }
  };
  return std::visit(Conversion{}, value);
}

py::dict to_python(const Values& values) {
  py::dict out;
  for (const auto& [name, value] : values) out[py::str(name)] = to_python(value);
  return out;
}

Values values_from(const py::dict& arguments, const std::vector<Parameter>& described) {
  Values values;
  for (const auto& [key, object] : arguments) {
    const std::string name = py::str(key);
    std::optional<Value> value = value_from(object);
    if (!value) {
      const auto it = std::find_if(described.begin(), described.end(),
                                   [&](const Parameter& p) { return p.name == name; });
      if (it != described.end())
        throw InvalidParameter(name + " is " + shown(object) + "; allowed is " +
                               std::string(to_string(it->type)) + " " + it->allowed());
      value = shown(object);  // the core refuses the name
    }
    values[name] = *std::move(value);
  }
  return values;
}

std::uint64_t whole_number(py::handle object, const char* name, std::uint64_t maximum) {
  if (PyIndex_Check(object.ptr())) {
    const auto whole = py::reinterpret_steal<py::object>(PyNumber_Index(object.ptr()));
    const std::uint64_t number = whole ? PyLong_AsUnsignedLongLong(whole.ptr()) : 0;
    if (!PyErr_Occurred() && number <= maximum) return number;
    PyErr_Clear();
  }
  throw InvalidParameter(std::string(name) + " is " + shown(object) +
                         "; allowed is a whole number in [0, " + std::to_string(maximum) + "]");
}

std::uint64_t seed_from(py::handle object) {
  return whole_number(object, "seed", std::numeric_limits<std::uint64_t>::max());
}

}  // namespace symsurf::python
