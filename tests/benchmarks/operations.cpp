// Seconds of every operation on a mesh of 100,002 vertices and 200,000 faces over a known plane and
// a known cylinder, on one thread. The mesh is a little asymmetric, and for complete it has a hole.

#include <benchmark/benchmark.h>
#include <symsurf/mirrors.h>
#include <symsurf/operations.h>

#include <cmath>
#include <memory>
#include <numbers>
#include <string>

namespace symsurf::benchmarks {

namespace {

constexpr Index meridians = 400, parallels = 250;

Mesh bumpy_ball() {
  Mesh mesh{Points(meridians * parallels + 2, 3), Triangles(2 * meridians * parallels, 3)};
  const Index north = meridians * parallels, south = north + 1;
  const auto radius = [](const Vector3& u) {
    return 1 + 0.1 * std::sin(3 * u.y() + 1) + 0.005 * std::sin(4 * u.x() + 2 * u.z());
  };
  for (Index ring = 0; ring < parallels; ++ring)
    for (Index k = 0; k < meridians; ++k) {
      const double angle = 2 * std::numbers::pi * static_cast<double>(k) / meridians;
      const double height = std::numbers::pi * static_cast<double>(ring + 1) / (parallels + 1);
      const Vector3 u(std::sin(height) * std::cos(angle), std::sin(height) * std::sin(angle),
                      std::cos(height));
      mesh.vertices.row(ring * meridians + k) = (radius(u) * u).transpose();
    }
  mesh.vertices.row(north) << 0, 0, radius(Vector3::UnitZ());
  mesh.vertices.row(south) << 0, 0, -radius(-Vector3::UnitZ());
  Index f = 0;
  for (Index k = 0; k < meridians; ++k) {
    const Index next = (k + 1) % meridians, last = (parallels - 1) * meridians;
    mesh.triangles.row(f++) << north, k, next;
    mesh.triangles.row(f++) << south, last + next, last + k;
    for (Index ring = 0; ring + 1 < parallels; ++ring) {
      const Index above = ring * meridians, below = above + meridians;
      mesh.triangles.row(f++) << above + k, below + k, below + next;
      mesh.triangles.row(f++) << above + k, below + next, above + next;
    }
  }
  return mesh;
}

// Without a third of one side.
Triangles with_hole(const Mesh& mesh) {
  Triangles faces = mesh.triangles;
  Index kept = 0;
  for (Index f = 0; f < faces.rows(); ++f)
    if (mesh.vertices(faces(f, 0), 0) < 0.6) faces.row(kept++) = faces.row(f).eval();
  faces.conservativeResize(kept, 3);
  return faces;
}

void operation(benchmark::State& state, const std::string& name, const Mirror& mirror) {
  static const Mesh mesh = bumpy_ball();
  static const Triangles cut = with_hole(mesh);
  const OperationInput input{mesh.vertices, name == "complete" ? cut : mesh.triangles};
  for (auto _ : state) operate(name, input, mirror, {}, Context(nullptr, 1));
}

}  // namespace

}  // namespace symsurf::benchmarks

int main(int argc, char** argv) {
  using namespace symsurf;
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  static const Plane plane(Vector3::UnitX(), 0);
  static const Cylinder cylinder(Vector3(-5, 0, 0), Vector3::UnitY(), 5);
  for (const Operation& each : operations())
    for (const Mirror* mirror :
         {static_cast<const Mirror*>(&plane), static_cast<const Mirror*>(&cylinder)})
      benchmark::RegisterBenchmark((each.name + ", " + std::string(mirror->kind())).c_str(),
                                   benchmarks::operation, each.name, std::cref(*mirror))
          ->Unit(benchmark::kMillisecond);
  benchmark::RunSpecifiedBenchmarks();
}
