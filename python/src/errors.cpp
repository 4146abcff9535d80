#include <symsurf/context.h>

#include "bindings.h"

namespace symsurf::python {

void bind_errors(py::module_& module) {
  py::register_exception<InvalidInput>(module, "InvalidInput", PyExc_ValueError).doc() =
      "The points, the normals or the file cannot be used; the message says why and what is "
      "needed.";
  py::register_exception<InvalidParameter>(module, "InvalidParameter", PyExc_ValueError).doc() =
      "An unknown method or parameter, or a value out of its range; the message names both.";
  py::register_exception<Cancelled>(module, "Cancelled", PyExc_RuntimeError).doc() =
      "The progress callback asked to stop.";
}

}  // namespace symsurf::python
