// How long somebody waits who cancels a method: the longest time from one report of progress to the
// next, where the method hears of it. One thread, so that its CPU seconds are the clock, and other
// work on the machine does not count. A method that is not done after SECONDS is cancelled.
//
//   silence [POINTS [SECONDS [METHOD...]]]

#include <symsurf/detect.h>
#include <symsurf/errors.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <string>
#include <vector>

#include "bumpy_object.h"

namespace symsurf::benchmarks {

namespace {

double cpu_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

struct Silence {
  double longest = 0;
  double before = 0;  // the fraction done, at the report that ended it
};

void measure(const std::string& method, const Points& points, double seconds) {
  Silence silence;
  const double start = cpu_seconds();
  double last = start;
  const auto hear = [&](double fraction) {
    const double now = cpu_seconds();
    if (now - last > silence.longest) silence = {now - last, fraction};
    last = now;
    return now - start < seconds;
  };
  const char* ended = "done";
  try {
    detect(points, {.method = method}, Context(hear, 1));
  } catch (const Cancelled&) {
    ended = "cancelled";
  }
  const double end = cpu_seconds();
  std::printf("%-20s %s after %6.2f s; longest silence %.3f s (before %.1f %%), the last %.3f s\n",
              method.c_str(), ended, end - start, silence.longest, 100 * silence.before,
              end - last);
  std::fflush(stdout);
}

}  // namespace

}  // namespace symsurf::benchmarks

int main(int argc, char** argv) {
  using namespace symsurf;
  const Points points = benchmarks::bumpy_object(argc > 1 ? std::atol(argv[1]) : 1'000'000);
  const double seconds = argc > 2 ? std::atof(argv[2]) : 60;
  std::vector<std::string> names(argv + std::min(argc, 3), argv + argc);
  if (names.empty())
    for (const Method& method : methods()) names.push_back(method.name);
  for (const std::string& name : names) benchmarks::measure(name, points, seconds);
}
