// Seconds, memory and the multiple of the unit (see unit.h) of every method, on one and two
// threads.

#include <benchmark/benchmark.h>
#include <symsurf/detect.h>

#include <chrono>
#include <memory>
#include <string>

#include "bumpy_object.h"
#include "memory.h"
#include "unit.h"

namespace symsurf::benchmarks {

namespace {

using Clock = std::chrono::steady_clock;

struct Input {
  explicit Input(Index count) : points(bumpy_object(count)), unit(unit_seconds(points)) {}

  Points points;
  double unit;
};

// The latest size only, so that ten million points are not held beside the rest.
const Input& input(Index count) {
  static std::unique_ptr<Input> latest;
  if (!latest || latest->points.rows() != count) {
    latest.reset();
    latest = std::make_unique<Input>(count);
  }
  return *latest;
}

void detection(benchmark::State& state, const std::string& method) {
  const Index count = state.range(0);
  const Input& given = input(count);
  const Context context(nullptr, static_cast<int>(state.range(1)));
  Options options;
  options.method = method;

  const PeakMemory memory;
  double score = 0;
  const auto start = Clock::now();
  for (auto _ : state) score = detect(given.points, options, context).score;
  state.counters["bytes/point"] = static_cast<double>(memory.bytes()) / static_cast<double>(count);
  state.counters["score"] = score;
  const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
  state.counters["units"] = seconds / static_cast<double>(state.iterations()) / given.unit;
  state.counters["unit_s"] = given.unit;
}

// What a method is expected to manage: those for big clouds are tried on big clouds.
Index largest(const Method& method) { return method.name == "plane" ? 10'000'000 : 100'000; }

void register_all() {
  for (Index count = 1000; count <= 10'000'000; count *= 10)
    for (const Method& method : methods())
      if (count <= largest(method))
        for (const int threads : {1, 2})
          benchmark::RegisterBenchmark(method.name.c_str(), detection, method.name)
              ->ArgNames({"points", "threads"})
              ->Args({count, threads})
              ->UseRealTime()
              ->Unit(benchmark::kMillisecond)
              ->MinTime(0.2);
}

}  // namespace

}  // namespace symsurf::benchmarks

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  symsurf::benchmarks::register_all();
  benchmark::RunSpecifiedBenchmarks();
}
