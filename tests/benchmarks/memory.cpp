#include "memory.h"

#include <malloc.h>

#include <fstream>
#include <string>

namespace symsurf::benchmarks {

namespace {

// A line of Linux's account of the process, in bytes.
std::int64_t account(const std::string& name) {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;)
    if (word == name + ":") {
      std::int64_t kilobytes = 0;
      status >> kilobytes;
      return 1024 * kilobytes;
    }
  return 0;
}

}  // namespace

PeakMemory::PeakMemory() {
  malloc_trim(0);                               // what was freed before does not count as held
  std::ofstream("/proc/self/clear_refs") << 5;  // the peak starts anew
  before_ = account("VmRSS");
}

std::int64_t PeakMemory::bytes() const { return account("VmHWM") - before_; }

}  // namespace symsurf::benchmarks
