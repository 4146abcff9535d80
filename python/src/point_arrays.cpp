#include "point_arrays.h"

namespace symsurf::python {

namespace {

py::object typed(const Eigen::MatrixXd& values, const PointArray& described) {
  py::object array =
      owned_array(Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>(values));
  if (described.components == 1) array = array.attr("ravel")();
  if (described.type == ParameterType::Boolean) return array.attr("astype")("bool");
  if (described.type == ParameterType::Integer) return array.attr("astype")("int64");
  return array;
}

}  // namespace

py::dict to_python(const std::map<std::string, Eigen::MatrixXd>& arrays,
                   const std::vector<PointArray>& described) {
  py::dict typed_arrays;
  for (const PointArray& array : described) {
    const auto found = arrays.find(array.name);
    if (found != arrays.end()) typed_arrays[py::str(array.name)] = typed(found->second, array);
  }
  return typed_arrays;
}

py::array_t<Index> to_python(const std::vector<Index>& values) {
  return py::array_t<Index>(static_cast<py::ssize_t>(values.size()), values.data());
}

}  // namespace symsurf::python
