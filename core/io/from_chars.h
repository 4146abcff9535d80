#pragma once

#include <charconv>

namespace symsurf {

#ifndef _WIN32
/// As std::from_chars, of real numbers, by what C libraries have: for C++ libraries that lack it.
std::from_chars_result from_chars_by_c(const char* begin, const char* end, double& number);
#endif

/// Apple's C++ library has it from macOS 26 on.
inline std::from_chars_result from_chars(const char* begin, const char* end, double& number) {
#ifdef __APPLE__
  return from_chars_by_c(begin, end, number);
#else
  return std::from_chars(begin, end, number);
#endif
}

}  // namespace symsurf
