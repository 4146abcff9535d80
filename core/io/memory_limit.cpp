#include <symsurf/io.h>

#ifdef _WIN32
#include <windows.h>
#else
#include <sys/resource.h>
#include <unistd.h>
#endif

#include <algorithm>

namespace symsurf {

#ifdef _WIN32

std::uintmax_t memory_limit() {
  MEMORYSTATUSEX machine{};
  machine.dwLength = sizeof machine;
  GlobalMemoryStatusEx(&machine);
  return std::min(machine.ullTotalPhys, machine.ullTotalVirtual);
}

#else

std::uintmax_t memory_limit() {
  const std::uintmax_t machine = static_cast<std::uintmax_t>(sysconf(_SC_PHYS_PAGES)) *
                                 static_cast<std::uintmax_t>(sysconf(_SC_PAGESIZE));
  rlimit process{};
  if (getrlimit(RLIMIT_AS, &process) != 0) return machine;  // RLIM_INFINITY is the largest number
  return std::min<std::uintmax_t>(machine, process.rlim_cur);
}

#endif

}  // namespace symsurf
