#pragma once

#include <pybind11/pybind11.h>
#include <symsurf/context.h>

namespace symsurf::python {

namespace py = pybind11;

/// A context that calls `callback(fraction)` (or nothing, for None) with the GIL on the calling
/// thread. False from it cancels, an exception passes through, and Ctrl-C is heard. The callback
/// and `threads` belong to the caller and must outlive the context.
/// Throws InvalidParameter for a callback that cannot be called or a bad number of threads.
Context context_from(py::handle callback, py::handle threads);

/// What work() returns, made with the GIL released.
template <typename Work>
auto without_gil(const Work& work) {
  const py::gil_scoped_release no_gil;
  return work();
}

/// What work(context) returns, made with the GIL released, on all threads of the machine; Ctrl-C
/// ends it.
template <typename Work>
auto interruptible(const Work& work) {
  const Context context = context_from(py::none(), py::int_(0));
  return without_gil([&] { return work(context); });
}

}  // namespace symsurf::python
