// Processes without points, or with none that is finite, hold nobody up and change no result.

#include <gtest/gtest.h>
#include <symsurf/context.h>
#include <symsurf/detect.h>

#include <atomic>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "expect_error.h"
#include "process_threads.h"
#include "processes/processes.h"
#include "random_cloud.h"

namespace symsurf::empty_processes_tests {
namespace {

constexpr int processes = 3;
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

// A ball with a bump; each point stands next to its image over x = 0.
Points bumpy_ball(Index count) {
  Points points = RandomCloud(7).sphere(count);
  for (Index i = 0; i < count; ++i) {
    points.row(i) *= 1 + 0.3 * std::sin(3 * points(i, 1) + 1) * std::cos(2 * points(i, 2));
    if (i % 2) points.row(i) = points.row(i - 1) * Vector3(-1, 1, 1).asDiagonal();
  }
  return points;
}

// Half of the points each for two processes; `third` for the one of rank `rank`.
std::vector<Points> shared_out(const Points& points, const Points& third, int rank) {
  std::vector<Points> parts{points.topRows(points.rows() / 2),
                            points.bottomRows(points.rows() - points.rows() / 2)};
  parts.insert(parts.begin() + rank, third);
  return parts;
}

Points joined(const std::vector<Points>& parts) {
  Points all(0, 3);
  for (const Points& part : parts) {
    const Index before = all.rows();
    all.conservativeResize(before + part.rows(), 3);
    all.bottomRows(part.rows()) = part;
  }
  return all;
}

Options options_of(const Method& method) {
  Options options{.method = method.name};
  // Its work grows with the cube of it.
  if (method.name == "sphere_thesis") options.parameters["sample_size"] = Index{60};
  return options;
}

// What each process gets: all the same but for the pairs, which are those of its own points.
void expect_result_of_whole(const std::vector<Points>& parts, const Options& options,
                            const std::string& what) {
  const Result whole = detect(joined(parts), options, Context({}, 1));
  std::vector<Result> results(processes);
  ProcessThreads(processes).run([&](const Communicator& all) {
    results[all.rank()] = detect(parts[all.rank()], options, Context({}, 1).sharing(&all));
  });
  Index row = 0;
  for (const Result& result : results) {
    EXPECT_NEAR(result.score, whole.score, 1e-9) << what;
    EXPECT_EQ(result.verdict(), whole.verdict()) << what;
    EXPECT_EQ(result.statistics.count("nonfinite_points"),
              whole.statistics.count("nonfinite_points"))
        << what;
    ASSERT_LE(row + result.pairs.rows(), whole.pairs.rows()) << what;
    EXPECT_EQ(result.pairs, whole.pairs.middleRows(row, result.pairs.rows())) << what;
    row += result.pairs.rows();
  }
  EXPECT_EQ(row, whole.pairs.rows()) << what;
}

TEST(EmptyProcesses, GetTheResultOfTheWholeFromEveryMethod) {
  const Points points = bumpy_ball(300), nothing(0, 3), unknown = Points::Constant(20, 3, nan);
  for (const Method& method : methods())
    for (const Points* third : {&nothing, &unknown})
      expect_result_of_whole(shared_out(points, *third, 1), options_of(method),
                             method.name + (third == &nothing ? ", no points" : ", no finite one"));
}

TEST(EmptyProcesses, ShareTheWorkOfOthers) {
  const Points points = bumpy_ball(10000), nothing(0, 3), unknown = Points::Constant(20, 3, nan);
  for (int rank = 0; rank < processes; ++rank)
    for (const Points* third : {&nothing, &unknown})
      expect_result_of_whole(
          shared_out(points, *third, rank), {.method = "plane"},
          "rank " + std::to_string(rank) + " has " + std::to_string(third->rows()));
}

// The same error on all, whoever has the points that are too few.
TEST(EmptyProcesses, AreToldWhatIsWrongWithTheWhole) {
  struct Case {
    std::string name, message;
    std::vector<Points> parts;
    bool refuse = false;
  };
  const Points nothing(0, 3), unknown = Points::Constant(20, 3, nan), few = bumpy_ball(2);
  const Points many = bumpy_ball(9000);
  const std::vector<Case> cases{
      {"nobody has a point", "0 points given", {nothing, nothing, nothing}},
      {"nobody has a finite point", "0 of 60 points given are finite", {unknown, unknown, unknown}},
      {"one has two points", "2 points given", {nothing, few, nothing}},
      {"one has two, one unknown ones", "2 of 22 points given are finite", {few, nothing, unknown}},
      {"unknown ones are refused", "point 9000 is", {many, nothing, unknown}, true},
  };
  for (const Case& each : cases)
    for (const char* method : {"auto", "plane", "sphere", "perpendicular"}) {
      std::vector<std::string> errors(processes);
      ProcessThreads(processes).run([&](const Communicator& all) {
        Options options{.method = method};
        options.refuse_nonfinite = each.refuse;
        try {
          detect(each.parts[all.rank()], options, Context({}, 1).sharing(&all));
        } catch (const InvalidInput& error) {
          errors[all.rank()] = error.what();
        }
      });
      for (const std::string& error : errors)
        EXPECT_EQ(error.find(each.message), 0u) << method << ", " << each.name << ": " << error;
    }
}

// The root asks for room before anything is sent: no process waits for one that has given up.
TEST(RunOnRoot, EveryProcessThrowsWhereTheRootHasNoRoom) {
  constexpr Index more_than_there_is = Index{1} << 60;
  std::atomic<int> refused = 0;
  ProcessThreads(3).run([&](const Communicator& processes) {
    const double nothing = 0;
    const PointsView own(&nothing, more_than_there_is);
    expect_error<InvalidInput>("do not fit into the memory of the first", [&] {
      run_on_root(own, {}, processes, [](PointsView, PointsView) { return Result(); });
    });
    ++refused;
  });
  EXPECT_EQ(refused, 3);
}

}  // namespace
}  // namespace symsurf::empty_processes_tests
