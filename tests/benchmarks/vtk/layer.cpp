// What vtkMirrorDetection costs beside the core: CPU seconds and memory, on the same points in one
// run; and how long it takes from an abort to the end.
//
//   layer [POINTS]

#include <symsurf/detect.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <limits>

#include "../bumpy_object.h"
#include "../memory.h"
#include "vtkCallbackCommand.h"
#include "vtkCommand.h"
#include "vtkDoubleArray.h"
#include "vtkMirrorDetection.h"
#include "vtkNew.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"

namespace symsurf::benchmarks {

namespace {

using Clock = std::chrono::steady_clock;

struct Cost {
  double cpu = std::numeric_limits<double>::infinity();
  double bytes = std::numeric_limits<double>::infinity();
};

// The least of a few runs.
template <typename Run>
Cost cost_of(const Run& run) {
  Cost least;
  for (int i = 0; i < 5; ++i) {
    const PeakMemory memory;
    const std::clock_t start = std::clock();
    run();
    least.cpu = std::min(least.cpu, static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
    least.bytes = std::min(least.bytes, static_cast<double>(memory.bytes()));
  }
  return least;
}

// Reads the core's points where they lie.
vtkNew<vtkPolyData> polydata_over(Points& points) {
  vtkNew<vtkDoubleArray> coordinates;
  coordinates->SetNumberOfComponents(3);
  coordinates->SetArray(points.data(), points.size(), 1);
  vtkNew<vtkPoints> vtk_points;
  vtk_points->SetData(coordinates);
  vtkNew<vtkPolyData> data;
  data->SetPoints(vtk_points);
  return data;
}

// The longest time from a report to the next one that an abort would have had to wait for.
double longest_silence(vtkMirrorDetection* detection) {
  struct Silence {
    Clock::time_point last = Clock::now();
    double longest = 0;
  } silence;
  vtkNew<vtkCallbackCommand> heard;
  heard->SetClientData(&silence);
  heard->SetCallback([](vtkObject*, unsigned long, void* data, void*) {
    auto* silence = static_cast<Silence*>(data);
    const Clock::time_point now = Clock::now();
    const double since = std::chrono::duration<double>(now - silence->last).count();
    silence->longest = std::max(silence->longest, since);
    silence->last = now;
  });
  const unsigned long tag = detection->AddObserver(vtkCommand::ProgressEvent, heard);
  detection->Modified();
  detection->Update();
  detection->RemoveObserver(tag);
  return silence.longest;
}

}  // namespace

}  // namespace symsurf::benchmarks

int main(int argc, char** argv) {
  using namespace symsurf;
  using namespace symsurf::benchmarks;
  Points points = bumpy_object(argc > 1 ? std::atol(argv[1]) : 1'000'000);
  const vtkNew<vtkPolyData> data = polydata_over(points);
  const double one_copy = static_cast<double>(points.size()) * sizeof(double);
  Options options;
  options.method = "plane";
  const Cost core = cost_of([&] { return detect(points, options, Context({}, 1)); });
  vtkNew<vtkMirrorDetection> detection;
  detection->SetInputData(data);
  detection->SetMethod("plane");
  detection->SetNumberOfThreads(1);
  const Cost vtk = cost_of([&] {
    detection->Modified();
    detection->Update();
  });
  std::printf("%td points: core %.3f s, VTK %.3f s (%+.1f %%); memory at the most %+.2f copies\n",
              points.rows(), core.cpu, vtk.cpu, 100 * (vtk.cpu / core.cpu - 1),
              (vtk.bytes - core.bytes) / one_copy);
  std::printf("an abort waits for at most %.3f s\n", longest_silence(detection));
}
