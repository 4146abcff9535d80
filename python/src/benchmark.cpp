#include <pybind11/stl.h>
#include <symsurf/synthetic.h>

#include <string>
#include <utility>

#include "arrays.h"
#include "bindings.h"
#include "context.h"
#include "values.h"

namespace symsurf::python {

void bind_benchmark(py::module_& module) {
  py::class_<BenchmarkCase>(module, "BenchmarkCase", "A case of the benchmark of curved mirrors.")
      .def_readonly("name", &BenchmarkCase::name)
      .def_readonly("shape", &BenchmarkCase::shape,
                    "\"creature\", \"head\", \"part\", \"mask\" or \"sheets\".")
      .def_readonly("bend", &BenchmarkCase::bend,
                    "\"straight\", \"bent\", \"domed\", \"waved\", \"twisted\", or \"none\": there "
                    "is no mirror.")
      .def_readonly("damage", &BenchmarkCase::damage,
                    "\"exact\", \"clean\", \"noise-0.5\", \"noise-1\", \"noise-2\", \"hole\", "
                    "\"half\" or \"density\".")
      .def_readonly("asymmetry", &BenchmarkCase::asymmetry,
                    "Root mean square of a smooth displacement, over the diagonal.");
  module.def("benchmark_cases", &benchmark_cases);
  // (points, images, partners, diagonal, kind, mirror), for symsurf.benchmark.
  module.def(
      "benchmark_sample",
      [](const std::string& name, const py::object& count, const py::object& seed) {
        constexpr std::uint64_t most = 1'000'000'000;
        const auto points = static_cast<Index>(whole_number(count, "count", most));
        const std::uint64_t drawn = seed_from(seed);
        BenchmarkSample sample = without_gil([&] { return benchmark_sample(name, points, drawn); });
        return py::make_tuple(owned_array(std::move(sample.points)),
                              owned_array(std::move(sample.images)), py::cast(sample.partners),
                              sample.diagonal, sample.kind, to_python(sample.mirror));
      },
      py::arg("name"), py::arg("count"), py::arg("seed"));
}

}  // namespace symsurf::python
