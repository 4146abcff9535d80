#pragma once

#include <algorithm>
#include <cstdint>
#include <cstdlib>

// How much the tests draw: little by default, SYMSURF_SEEDS=8 or more is the full run.
// tests/seeds.py is the same of Python's tests.

namespace symsurf {

/// Seeds of repeated tests: whatever fails for one of them fails.
inline const std::uint64_t seeds = [] {
  const char* given = std::getenv("SYMSURF_SEEDS");
  return given ? std::max<std::uint64_t>(std::strtoull(given, nullptr, 10), 1) : 2;
}();

constexpr std::uint64_t seeds_of_the_full_run = 8;

/// How many draws there are where the full run makes so many.
inline std::uint64_t draws(std::uint64_t of_the_full_run) {
  return (of_the_full_run * seeds + seeds_of_the_full_run - 1) / seeds_of_the_full_run;
}

/// Seeds of tests that take seconds for each.
inline const std::uint64_t slow_seeds = draws(4);

}  // namespace symsurf

/// Skips a test that takes long for what it shows, or whose fault a few draws do not show.
#define SYMSURF_FULL_RUN_ONLY()                        \
  if (symsurf::seeds < symsurf::seeds_of_the_full_run) \
  GTEST_SKIP() << "only in the full run: make test-full"
