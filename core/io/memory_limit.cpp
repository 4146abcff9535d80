#include "memory_limit.h"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>

namespace symsurf {

std::uintmax_t memory_limit() {
  const std::uintmax_t machine = static_cast<std::uintmax_t>(sysconf(_SC_PHYS_PAGES)) *
                                 static_cast<std::uintmax_t>(sysconf(_SC_PAGESIZE));
  rlimit process{};
  if (getrlimit(RLIMIT_AS, &process) != 0) return machine;  // RLIM_INFINITY is the largest number
  return std::min<std::uintmax_t>(machine, process.rlim_cur);
}

}  // namespace symsurf
