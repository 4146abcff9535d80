// How long somebody waits who cancels a method or an operation: the longest time from one report of
// progress to the next, where the call hears of it, and the time from a wish that comes at a random
// moment to the end of the call. One thread, so that its CPU seconds are the clock, and other work
// on the machine does not count. A call that is not done after SECONDS is cancelled.
//
//   silence [POINTS [SECONDS [WISHES [NAME...]]]]

#include <symsurf/context.h>
#include <symsurf/detect.h>
#include <symsurf/mirrors.h>
#include <symsurf/operations.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <functional>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "bumpy_object.h"

namespace symsurf::benchmarks {

namespace {

double cpu_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

struct Call {
  std::string name;
  std::function<void(const Context&)> run;
};

std::vector<Call> calls(const Points& points) {
  std::vector<Call> all;
  for (const Method& method : methods())
    all.push_back({method.name, [&](const Context& context) {
                     detect(points, {.method = method.name}, context);
                   }});
  const std::shared_ptr<Mirror> mirror = detect(points, {.method = "plane"}).mirror;
  for (const Operation& operation : operations())
    all.push_back({operation.name, [&points, &operation, mirror](const Context& context) {
                     operate(operation.name, {points}, *mirror, {}, context);
                   }});
  return all;
}

// As long as `goes_on` says so; the seconds that the call took.
double run(const Call& call, const std::function<bool(double)>& goes_on, const char** ended) {
  const double start = cpu_seconds();
  *ended = "done";
  try {
    call.run(Context(goes_on, 1));
  } catch (const Cancelled&) {
    *ended = "cancelled";
  }
  return cpu_seconds() - start;
}

// The longest of so many waits.
double longest_wait(const Call& call, double seconds, int wishes) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> moment(0, seconds);
  double longest = 0;
  for (int i = 0; i < wishes; ++i) {
    const double wish = cpu_seconds() + moment(random);
    const char* ended;
    run(
        call, [&](double) { return cpu_seconds() < wish; }, &ended);
    longest = std::max(longest, cpu_seconds() - wish);
  }
  return longest;
}

void measure(const Call& call, double seconds, int wishes) {
  double longest = 0, before = 0;  // the fraction done, at the report that ended it
  const double start = cpu_seconds();
  double last = start;
  const auto hear = [&](double fraction) {
    const double now = cpu_seconds();
    if (now - last > longest) longest = now - last, before = fraction;
    last = now;
    return now - start < seconds;
  };
  const char* ended;
  const double took = run(call, hear, &ended);
  std::printf("%-20s %-9s after %6.2f s; longest silence %.3f s (before %.1f %%), the last %.3f s",
              call.name.c_str(), ended, took, longest, 100 * before, cpu_seconds() - last);
  if (wishes > 0)
    std::printf("; the longest of %d waits %.3f s", wishes, longest_wait(call, took, wishes));
  std::printf("\n");
  std::fflush(stdout);
}

}  // namespace

}  // namespace symsurf::benchmarks

int main(int argc, char** argv) {
  using namespace symsurf;
  const Points points = benchmarks::bumpy_object(argc > 1 ? std::atol(argv[1]) : 1'000'000);
  const double seconds = argc > 2 ? std::atof(argv[2]) : 60;
  const int wishes = argc > 3 ? std::atoi(argv[3]) : 0;
  const std::vector<std::string> names(argv + std::min(argc, 4), argv + argc);
  for (const benchmarks::Call& call : benchmarks::calls(points))
    if (names.empty() || std::find(names.begin(), names.end(), call.name) != names.end())
      benchmarks::measure(call, seconds, wishes);
}
