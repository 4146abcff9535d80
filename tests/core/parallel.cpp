#include "base/parallel.h"

#include <gtest/gtest.h>
#include <symsurf/context.h>
#ifndef _WIN32
#include <sys/resource.h>
#endif

#include <atomic>
#include <cstdlib>
#include <stdexcept>
#include <thread>
#include <vector>

#include "random_cloud.h"

namespace symsurf::parallel_tests {
namespace {

TEST(Parallel, VisitsEveryItemOnceInChunksThatThreadsDoNotChange) {
  for (const int threads : {1, 2, 5})
    for (const Index count : {0, 1, 99, 100, 101, 1234}) {
      std::vector<std::atomic<int>> visits(count);
      parallel_for(Context({}, threads), count, 100, [&](Index begin, Index end) {
        EXPECT_EQ(begin % 100, 0);
        EXPECT_EQ(end, std::min(count, begin + 100));
        for (Index i = begin; i < end; ++i) ++visits[i];
      });
      for (const auto& visit : visits) EXPECT_EQ(visit, 1);
    }
}

TEST(Parallel, SumsToTheSameBitsForAnyNumberOfThreads) {
  const Points points = RandomCloud(0).box(10000);
  const auto sum = [&](int threads) {
    return parallel_sum(Context({}, threads), points.rows(), 64, 0.0, [&](Index begin, Index end) {
      double part = 0;
      for (Index i = begin; i < end; ++i) part += points(i, 0);
      return part;
    });
  };
  for (const int threads : {2, 3, 8}) EXPECT_EQ(sum(threads), sum(1));
  EXPECT_NEAR(sum(1), points.col(0).sum(), 1e-10);
}

// Of what is done at the same time nothing is told, and it starts no threads of its own.
TEST(Parallel, TellsNothingOfNestedCalls) {
  const auto caller = std::this_thread::get_id();
  double told = 0;
  const Context context(
      [&](double fraction) {
        EXPECT_EQ(std::this_thread::get_id(), caller);
        told = fraction;
        return true;
      },
      4);
  parallel_for(context, 8, 1, [&](Index, Index) {
    const auto outer = std::this_thread::get_id();
    parallel_for(context, 8, 1, [&](Index, Index) {
      EXPECT_EQ(std::this_thread::get_id(), outer);
      context.report(1);
    });
    if (outer == caller) {
      EXPECT_LT(told, 1);
    }
  });
  EXPECT_EQ(told, 1);
}

TEST(Parallel, HandsOnWhatTheBodyThrows) {
  for (const int threads : {1, 4})
    EXPECT_THROW(parallel_for(Context({}, threads), 1000, 1,
                              [](Index begin, Index) {
                                if (begin == 500) throw std::length_error("too long");
                              }),
                 std::length_error);
}

#ifndef _WIN32

// In a process of its own, which has no room for their stacks.
TEST(Parallel, DoesWithFewerThreadsWhereTheSystemGivesNoMore) {
  const auto work = [] {
    const rlimit room{1 << 28, 1 << 28};
    setrlimit(RLIMIT_AS, &room);
    constexpr Index count = 10000;
    std::atomic<Index> visited{0};
    parallel_for(Context({}, 5000), count, 1, [&](Index, Index) { ++visited; });
    std::_Exit(visited == count ? 0 : 1);
  };
  EXPECT_EXIT(work(), testing::ExitedWithCode(0), "");
}

#endif

}  // namespace
}  // namespace symsurf::parallel_tests
