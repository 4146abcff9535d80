// SPDX-License-Identifier: GPL-3.0-or-later
//
// How long MeshLab waits when somebody cancels a filter. A filter hears of it the next time it
// reports, so what counts is the longest silence before its last report, and then the time from the
// answer "stop" to the filter's end. CPU seconds with one thread: what other programs do does not
// count, and more threads only shorten it.
//
//   meshlab_cancel PLUGIN METHOD VERTICES

#include <QApplication>
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <string>

#include "plugin_host.h"

namespace {

double seconds(std::clock_t from, std::clock_t to) {
  return static_cast<double>(to - from) / CLOCKS_PER_SEC;
}

struct Silence {
  double longest = 0;
  int before = 0;  // percent, at the report that ended it
};

Silence longest_silence(Run& run, int size) {
  MeshDocument document;
  add_lump(document, size);
  Silence silence;
  std::clock_t last = std::clock();
  on_progress = [&](int percent) {
    const std::clock_t now = std::clock();
    if (seconds(last, now) > silence.longest) silence = {seconds(last, now), percent};
    last = now;
    return true;
  };
  run(document, progress_callback);
  return silence;
}

double time_to_stop(Run& run, int size, int percent) {
  MeshDocument document;
  add_lump(document, size);
  std::clock_t told = std::clock();
  on_progress = [&](int now) {
    told = std::clock();
    return now < percent;
  };
  run(document, progress_callback);
  return seconds(told, std::clock());
}

}  // namespace

int main(int argc, char** argv) {
  QCoreApplication application(argc, argv);
  if (argc != 4) return 2;
  FilterPlugin& plugin = load_plugin(argv[1]);
  const int size = std::atoi(argv[3]);
  for (QAction* action : plugin.actions()) {
    Run run(plugin, action);
    run.use_one_thread();
    if (run.name() != "compute_mirror_" + std::string(argv[2])) continue;
    const Silence silence = longest_silence(run, size);
    double stop = 0;
    for (const int percent : {1, 10, 30, 50, 70, 90})
      stop = std::max(stop, time_to_stop(run, size, percent));
    std::printf("%s, %d vertices: longest silence %.3f s (before %d %%), then stops in %.3f s\n",
                argv[2], size, silence.longest, silence.before, stop);
  }
  std::fflush(stdout);
  std::_Exit(0);
}
