#pragma once

#include <symsurf/operations.h>

#include <map>
#include <string>
#include <vector>

#include "arrays.h"

namespace symsurf::python {

/// What an operation or an analysis gives each point, by name, in the types that it describes.
py::dict to_python(const std::map<std::string, Eigen::MatrixXd>& arrays,
                   const std::vector<PointArray>& described);

py::array_t<Index> to_python(const std::vector<Index>& values);

}  // namespace symsurf::python
