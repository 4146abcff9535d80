#include "context.h"

#include <symsurf/context.h>

#include <limits>

#include "values.h"

namespace symsurf::python {

namespace {

bool is_false(py::handle answer) {
  py::detail::make_caster<bool> boolean;  // without conversion: None and 0 do not cancel
  return boolean.load(answer, false) && !static_cast<bool>(boolean);
}

}  // namespace

Context context_from(py::handle callback, py::handle threads) {
  if (!callback.is_none() && !PyCallable_Check(callback.ptr()))
    throw InvalidParameter("progress is " + py::repr(callback).cast<std::string>() +
                           "; allowed is None or a function of the fraction done");
  const auto count =
      static_cast<int>(whole_number(threads, "threads", std::numeric_limits<int>::max()));
  // A bare handle: the context is copied where the GIL is not held.
  return Context(
      [callback](double fraction) {
        const py::gil_scoped_acquire gil;
        if (PyErr_CheckSignals() != 0) throw py::error_already_set();
        return callback.is_none() || !is_false(callback(fraction));
      },
      count);
}

}  // namespace symsurf::python
