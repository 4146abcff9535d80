#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <string>

#include "io/formats.h"

namespace symsurf::from_chars_tests {
namespace {

#ifndef _WIN32

void expect_as_of_the_library(const std::string& word) {
  double known = 7, found = 7;
  const char* end = word.data() + word.size();
  const auto said = std::from_chars(word.data(), end, known);
  const auto [stop, error] = from_chars_by_c(word.data(), end, found);
  EXPECT_EQ(stop - word.data(), said.ptr - word.data()) << word;
  EXPECT_EQ(error, said.ec) << word;
  EXPECT_TRUE(std::memcmp(&found, &known, sizeof known) == 0 || std::isnan(known)) << word;
}

TEST(FromChars, OfCAreThoseOfTheLibrary) {
  for (const char* word : {"0",
                           "-0",
                           "1.5",
                           ".5",
                           "5.",
                           "-1e-3",
                           "1E+20",
                           "1e",
                           "1e+",
                           "0.1",
                           "123456789012345678901",
                           "2.2250738585072011e-308",
                           "5e-324",
                           "1e-310",
                           "1e-400",
                           "1e400",
                           "-1e400",
                           "inf",
                           "-inf",
                           "Infinity",
                           "nan",
                           "NaN",
                           "0x10",
                           "1x",
                           "+1",
                           " 1",
                           "",
                           "-",
                           "--1",
                           ".",
                           "e5",
                           "1,5",
                           "1.2.3"})
    expect_as_of_the_library(word);
}

#endif

}  // namespace
}  // namespace symsurf::from_chars_tests
