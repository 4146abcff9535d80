#include <symsurf/io.h>

#include "formats.h"

#ifdef _WIN32
#include <windows.h>
#else
#include <locale.h>
#include <stdlib.h>
#include <sys/resource.h>
#include <unistd.h>
#ifdef __APPLE__
#include <xlocale.h>
#endif
#endif

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cmath>
#include <string>

// What C++ cannot tell everywhere.

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

std::from_chars_result from_chars_by_c(const char* begin, const char* end, double& number) {
  static const locale_t plain = newlocale(LC_ALL_MASK, "C", nullptr);
  std::string text(begin, end);
  // strtod passes over blanks and a plus sign, and takes hexadecimal numbers.
  if (text.empty() || text[0] == '+' || std::isspace(static_cast<unsigned char>(text[0])))
    return {begin, std::errc::invalid_argument};
  text.resize(std::min(text.find_first_of("xX"), text.size()));
  char* stop = nullptr;
  errno = 0;
  const double value = strtod_l(text.c_str(), &stop, plain);
  const char* read = begin + (stop - text.c_str());
  if (read == begin) return {begin, std::errc::invalid_argument};
  // It is so of denormal numbers too.
  if (errno == ERANGE && (value == 0 || std::isinf(value)))
    return {read, std::errc::result_out_of_range};
  number = value;
  return {read, std::errc()};
}

#endif

}  // namespace symsurf
