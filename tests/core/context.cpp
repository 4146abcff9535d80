#include <gtest/gtest.h>
#include <symsurf/symsurf.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <ctime>
#include <functional>
#include <memory>
#include <stdexcept>
#include <thread>
#include <vector>

#include "expect_error.h"
#include "random_cloud.h"
#include "triangle_soup.h"

namespace symsurf::context_tests {
namespace {

struct LongCall {
  std::string name;
  std::function<void(const Context&)> run;
};

// Every call that takes a context, on a cloud large enough for several reports.
std::vector<LongCall> long_calls() {
  static const Points points = RandomCloud(0).sphere(20000);
  std::vector<LongCall> calls{
      {"estimate_normals",
       [](const Context& context) { estimate_normals(points, 10, "pca", context); }},
      {"match",
       [](const Context& context) {
         match(points, Plane({1, 0, 0}, 0), 0.05, context);
       }},
      // Half its time it lays the mirror out, before it carries a point.
      {"bend", [](const Context& context) {
         bend(points, Sphere({0, 0, -3}, 3), Bend::Straighten, context);
       }}};
  static const Points few = RandomCloud(0).sphere(60), corners = RandomCloud(0).sphere(1500);
  static const Triangles soup = triangle_soup(corners);
  for (const Method& method : methods()) {
    Options options{.method = method.name};
    // Its work grows with the cube of it.
    if (method.name == "sphere_thesis") options.parameters["sample_size"] = Index{60};
    calls.push_back(
        {method.name, [options](const Context& context) { detect(few, options, context); }});
  }
  for (const Analysis& analysis : analyses())
    calls.push_back({analysis.name, [&analysis](const Context& context) {
                       AnalysisOptions options;
                       if (analysis.takes_other) options.other = few;
                       analyse(analysis.name, few, options, context);
                     }});
  for (const Operation& operation : operations())
    calls.push_back({operation.name, [&operation](const Context& context) {
                       const OperationInput input = operation.needs_faces
                                                        ? OperationInput{corners, soup}
                                                        : OperationInput{points};
                       operate(operation.name, input, Plane({1, 0, 0}, 0), {}, context);
                     }});
  return calls;
}

// They have no progress to report, and can be stopped all the same.
TEST(Context, IsAskedByCallsWithoutReports) {
  const Points points = RandomCloud(1).sphere(5000);
  // Another each time: one that was just asked is not asked again so soon.
  const auto stop = [] { return Context([](double) { return false; }); };
  EXPECT_THROW(stop().check(), Cancelled);
  EXPECT_THROW(downsample(points, 100, stop()), Cancelled);
  EXPECT_THROW(HeightField({0, 0, 1}, points, stop()), Cancelled);
  for (const std::shared_ptr<Mirror>& mirror : std::vector<std::shared_ptr<Mirror>>{
           std::make_shared<Plane>(Vector3(1, 0, 0), 0),
           std::make_shared<Sphere>(Vector3(0, 0, -2), 2),
           std::make_shared<Cylinder>(Vector3(0, 0, -2), Vector3(1, 0, 0), 2),
           std::make_shared<HeightField>(Vector3(0, 0, 1), points),
           std::make_shared<Quadric>(Matrix3::Identity(), Vector3(0, 0, 2), -1)})
    EXPECT_THROW(mirror->mesh(points, 64, stop()), Cancelled) << mirror->kind();
}

TEST(Context, ReportsFromZeroToOneNeverBackwardsOnTheCallingThread) {
  for (const LongCall& call : long_calls())
    for (const int threads : {1, 3}) {
      std::vector<double> fractions;
      const std::thread::id caller = std::this_thread::get_id();
      std::atomic<bool> elsewhere = false;
      call.run(Context(
          [&](double fraction) {
            if (std::this_thread::get_id() != caller) elsewhere = true;
            fractions.push_back(fraction);
            return true;
          },
          threads));
      EXPECT_FALSE(elsewhere) << call.name;
      ASSERT_GE(fractions.size(), 2u) << call.name;
      EXPECT_TRUE(std::is_sorted(fractions.begin(), fractions.end())) << call.name;
      EXPECT_GE(fractions.front(), 0) << call.name;
      EXPECT_EQ(fractions.back(), 1) << call.name;
    }
}

class LongCalls : public testing::TestWithParam<std::size_t> {
 protected:
  const LongCall call = long_calls()[GetParam()];
};

// The wish comes at a random moment, and is heard at the next report.
TEST_P(LongCalls, AreCancelledAtRandomMoments) {
  constexpr int threads = 2, cancels = 10;
  using Clock = std::chrono::steady_clock;
  RandomCloud random(17);
  const Clock::time_point begin = Clock::now();
  call.run(Context([](double) { return true; }, threads));
  const Clock::duration whole = Clock::now() - begin;
  int cancelled = 0;
  for (int i = 0; i < cancels; ++i) {
    const auto wish =
        Clock::now() + std::chrono::duration_cast<Clock::duration>(random.uniform(0, 1) * whole);
    bool told = false;
    const Context context(
        [&](double) {
          EXPECT_FALSE(told) << call.name << " reported after it was cancelled";
          told = Clock::now() >= wish;
          return !told;
        },
        threads);
    try {
      call.run(context);
      // A run that is quicker than the first may be over before.
      EXPECT_FALSE(told) << call.name << " went on";
    } catch (const Cancelled&) {
      EXPECT_TRUE(told) << call.name;
      ++cancelled;
    }
  }
  EXPECT_GT(cancelled, 0) << call.name;
}

INSTANTIATE_TEST_SUITE_P(Every, LongCalls, testing::Range(std::size_t{0}, long_calls().size()),
                         [](const auto& tested) { return long_calls()[tested.param].name; });

// It fitted a surface and knew nothing of a wish to cancel. In CPU seconds of one thread, against
// the time of the whole: neither other work on the machine nor its speed counts.
TEST(Context, IsAskedByFixedDirectionAllTheTime) {
  const Points points = RandomCloud(0).sphere(200'000) * Vector3(1, 0.7, 0.4).asDiagonal();
  const std::clock_t start = std::clock();
  std::clock_t last = start, longest = 0;
  const auto hear = [&](double) {
    const std::clock_t now = std::clock();
    longest = std::max(longest, now - last);
    last = now;
    return true;
  };
  detect(points, {.method = "fixed_direction"}, Context(hear, 1));
  longest = std::max(longest, std::clock() - last);
  EXPECT_LE(static_cast<double>(longest), 0.06 * static_cast<double>(std::clock() - start));
}

// The mirror is laid out over all points before one is carried along.
TEST(Context, IsAskedByBendWhileItLaysTheMirrorOut) {
  const Points points = RandomCloud(0).sphere(400'000);
  int asked = 0;
  double last = 0;
  EXPECT_THROW(bend(points, Sphere({0, 0, -3}, 3), Bend::Straighten,
                    Context(
                        [&](double fraction) {
                          last = fraction;
                          return ++asked < 2;
                        },
                        1)),
               Cancelled);
  EXPECT_EQ(last, 0);
}

TEST(Context, HandsOnWhatTheCallbackThrows) {
  for (const LongCall& call : long_calls())
    EXPECT_THROW(
        call.run(Context(
            [](double fraction) -> bool { throw std::length_error(std::to_string(fraction)); }, 2)),
        std::length_error);
}

TEST(Context, ServesManyCallersAtOnce) {
  const Points points = RandomCloud(3).sphere(500) * Vector3(1, 0.7, 0.4).asDiagonal();
  for (const char* method : {"auto", "cylinder", "perpendicular"}) {
    const Result alone = detect(points, {.method = method}, Context({}, 1));
    std::vector<Result> results(4);
    std::vector<std::thread> callers;
    for (Result& result : results)
      callers.emplace_back([&] { result = detect(points, {.method = method}, Context({}, 2)); });
    for (std::thread& caller : callers) caller.join();
    for (const Result& result : results) {
      EXPECT_EQ(result.score, alone.score) << method;
      EXPECT_EQ(result.pairs, alone.pairs) << method;
      EXPECT_EQ(result.residuals, alone.residuals) << method;
    }
  }
}

TEST(Context, StagesMapIntoTheWhole) {
  double last = -1;
  const Context whole([&](double fraction) {
    last = fraction;
    return true;
  });
  const Context part = whole.stage(0.5, 0.75).stage(0, 0.5);
  part.report(0);
  EXPECT_EQ(last, 0.5);
  part.report(1);
  EXPECT_EQ(last, 0.625);
  EXPECT_EQ(part.threads(), whole.threads());
}

TEST(Context, KnowsItsThreads) {
  EXPECT_GE(Context().threads(), 1);
  EXPECT_GE(Context({}, 0).threads(), 1);
  EXPECT_EQ(Context({}, 3).threads(), 3);
  expect_error<InvalidParameter>("threads is -1; allowed are 0", [] { Context({}, -1); });
}

}  // namespace
}  // namespace symsurf::context_tests
