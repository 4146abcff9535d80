#include "bindings.h"

PYBIND11_MODULE(_core, module) {
  using namespace symsurf::python;
  module.doc() = "The compiled part of symsurf; use the package's own names.";
  module.attr("__version__") = SYMSURF_VERSION;
  bind_errors(module);
  bind_methods(module);
  bind_mirrors(module);
  bind_optics(module);
  bind_detection(module);
  bind_sampling(module);
  bind_summary(module);
  bind_reading(module);
  bind_synthesis(module);
  bind_benchmark(module);
  bind_metrics(module);
  bind_operations(module);
  bind_analyses(module);
}
