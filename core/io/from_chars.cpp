#include "from_chars.h"

#ifndef _WIN32

#include <locale.h>
#include <stdlib.h>
#ifdef __APPLE__
#include <xlocale.h>
#endif

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cmath>
#include <string>

namespace symsurf {

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

}  // namespace symsurf

#endif
