#pragma once

#include <pybind11/numpy.h>
#include <pybind11/stl.h>
#include <symsurf/points.h>

#include <memory>
#include <optional>
#include <utility>

namespace symsurf::python {

namespace py = pybind11;

/// Rows of three numbers as Python gave them: the caller's own memory where that is an (n, 3)
/// float64 array in C order, otherwise one converted copy.
struct Rows {
  py::array_t<double, py::array::c_style> array;

  operator PointsView() const { return {array.data(), static_cast<Index>(array.shape(0))}; }
};

struct PointsArgument : Rows {};
struct NormalsArgument : Rows {};

/// Points that are no mesh or data set.
struct BarePointsArgument : Rows {};

struct VectorArgument {
  Vector3 vector;
};

/// (m, 3) indices of points, which the package has made sure of; none for a bare cloud.
using FacesArgument = std::optional<py::array_t<Index, py::array::c_style>>;

inline TrianglesView view_of(const FacesArgument& faces) {
  return faces ? TrianglesView(faces->data(), static_cast<Index>(faces->shape(0)))
               : TrianglesView();
}

/// Reads anything array-like. Throws InvalidInput naming `what`, the shape or type that was given
/// and what is allowed.
Rows rows_from(py::handle object, const char* what);

/// Throws InvalidInput naming the shape given, unless that is three numbers.
VectorArgument vector_from(py::handle object);

/// Whether it is a mesh, a cloud or a table: has points or vertices and is no array itself, or is
/// an object that `symsurf.shapes.objects` knows.
bool has_points(py::handle object);

/// The points of such an object, else the object itself.
py::object points_of(py::handle object);

/// An array over memory that `owner` keeps alive; nothing is copied.
template <typename Matrix>
py::array_t<typename Matrix::Scalar> shared_array(const Matrix& matrix,
                                                  std::shared_ptr<const void> owner) {
  using Scalar = typename Matrix::Scalar;
  constexpr auto size = static_cast<py::ssize_t>(sizeof(Scalar));
  std::vector<py::ssize_t> shape{matrix.rows()}, strides{matrix.rowStride() * size};
  if constexpr (Matrix::ColsAtCompileTime != 1) {
    shape.push_back(matrix.cols());
    strides.push_back(matrix.colStride() * size);
  }
  const py::capsule keep_alive(new std::shared_ptr<const void>(std::move(owner)), [](void* held) {
    delete static_cast<std::shared_ptr<const void>*>(held);
  });
  return {shape, strides, matrix.data(), keep_alive};
}

/// An array that takes the matrix over.
template <typename Matrix>
auto owned_array(Matrix&& matrix) {
  auto kept = std::make_shared<std::decay_t<Matrix>>(std::forward<Matrix>(matrix));
  return shared_array(*kept, kept);
}

}  // namespace symsurf::python

namespace pybind11::detail {

template <typename Argument>
struct array_like_caster {
  PYBIND11_TYPE_CASTER(Argument, const_name("numpy.typing.ArrayLike"));
};

template <>
struct type_caster<symsurf::python::PointsArgument>
    : array_like_caster<symsurf::python::PointsArgument> {
  bool load(handle source, bool) {
    value = {symsurf::python::rows_from(symsurf::python::points_of(source), "points")};
    return true;
  }
};

template <>
struct type_caster<symsurf::python::BarePointsArgument>
    : array_like_caster<symsurf::python::BarePointsArgument> {
  bool load(handle source, bool) {
    if (symsurf::python::has_points(source)) return false;
    value = {symsurf::python::rows_from(source, "points")};
    return true;
  }
};

template <>
struct type_caster<symsurf::python::NormalsArgument>
    : array_like_caster<symsurf::python::NormalsArgument> {
  bool load(handle source, bool) {
    value = {symsurf::python::rows_from(source, "normals")};
    return true;
  }
};

template <>
struct type_caster<symsurf::python::VectorArgument>
    : array_like_caster<symsurf::python::VectorArgument> {
  bool load(handle source, bool) {
    value = symsurf::python::vector_from(source);
    return true;
  }
};

}  // namespace pybind11::detail
