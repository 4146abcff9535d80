// Seconds of reflection_points() for 100,000 random sources and one eye, on one thread.

#include <benchmark/benchmark.h>
#include <symsurf/mirrors.h>

#include <memory>
#include <string>

#include "core/random_cloud.h"

namespace symsurf::benchmarks {

namespace {

void reflection(benchmark::State& state, const Mirror& mirror) {
  RandomCloud random(1);
  const Points sources = 2 * random.box(100'000);
  const Context one_thread(nullptr, 1);
  Index found = 0;
  for (auto _ : state)
    found = reflection_points(mirror, sources, {0.7, 0.2, 1.3}, one_thread).positions.rows();
  state.counters["found"] = static_cast<double>(found);
}

void add(const std::string& name, std::shared_ptr<const Mirror> mirror) {
  benchmark::RegisterBenchmark(name.c_str(), [mirror](benchmark::State& state) {
    reflection(state, *mirror);
  })->Unit(benchmark::kMillisecond);
}

void register_all() {
  const Matrix3 turn = RandomCloud(2).rotation();
  const auto quadric = [&](const Vector3& curves, const Vector3& linear, double constant) {
    return std::make_shared<Quadric>(turn * curves.asDiagonal() * turn.transpose(), turn * linear,
                                     constant);
  };
  add("ellipsoid", quadric({1, 0.6, 1.7}, {0.1, 0.2, 0}, -1));
  add("hyperboloid", quadric({1, 0.6, -1.7}, {0.1, 0.2, 0}, -1));
  add("paraboloid", quadric({1, 0.6, 0}, {0.1, 0.2, -1}, 0));
  add("paraboloid of revolution", quadric({1, 1, 0}, {0, 0, -1}, 0));
  add("sphere", std::make_shared<Sphere>(Vector3::Zero(), 1));
  add("cylinder", std::make_shared<Cylinder>(Vector3::Zero(), Vector3::UnitZ(), 1));
}

}  // namespace

}  // namespace symsurf::benchmarks

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  symsurf::benchmarks::register_all();
  benchmark::RunSpecifiedBenchmarks();
}
