// Processes that share out a point set find what one process finds.

#include <gtest/gtest.h>
#include <symsurf/context.h>
#include <symsurf/detect.h>
#include <symsurf/mirrors.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <random>
#include <string>

#include "process_threads.h"
#include "random_cloud.h"

namespace symsurf::shared_points_tests {

namespace {

constexpr Index size = 12000, many = 300'000;  // which the root takes, or takes thinned

// A dented ball with noise and a hole: no point has an exact partner. Every other seed has clutter
// about it, and a few points far off.
Points scan(unsigned seed, Index count = size) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  const Plane mirror(Vector3(normal(random), normal(random), normal(random)), 0.7);
  Points points(count, 3);
  for (Index i = 0; i < count; ++i) {
    Vector3 u = Vector3(normal(random), normal(random), normal(random)).normalized();
    while (u.y() > 0.9) u = Vector3(normal(random), normal(random), normal(random)).normalized();
    Vector3 x = (1 + 0.3 * std::sin(3 * u.y() + u.z()) + 0.2 * u.y() * u.z()) * u;
    x.x() += 2;
    if (i % 2) x = mirror.reflect(x);
    const bool clutter = seed % 2 && i % 50 == 0, outlier = seed % 2 && i % 600 == 1;
    if (clutter || outlier) x = (outlier ? 50 : 1) * Vector3(normal(random), normal(random), 2);
    points.row(i) = (x + 0.003 * Vector3(normal(random), normal(random), normal(random)));
  }
  return points;
}

using Owner = int (*)(const Points&, Index, int);

int by_turns(const Points&, Index i, int processes) { return static_cast<int>(i % processes); }
int by_place(const Points& points, Index i, int processes) {
  const double share = (points(i, 1) + 2) / 4;  // most of a scan lies between -2 and 2
  return std::clamp(static_cast<int>(share * processes), 0, processes - 1);
}
int never_the_first(const Points&, Index i, int processes) {
  return 1 + static_cast<int>(i % (processes - 1));
}

// Which rows each process has; numbered through, they are the rows in this order.
std::vector<std::vector<Index>> shared_out(const Points& points, int processes, Owner owner) {
  std::vector<std::vector<Index>> rows(processes);
  for (Index i = 0; i < points.rows(); ++i) rows[owner(points, i, processes)].push_back(i);
  return rows;
}

std::vector<Result> detected(const Points& points, const std::vector<std::vector<Index>>& rows,
                             const Options& options) {
  std::vector<Result> results(rows.size());
  ProcessThreads(static_cast<int>(rows.size())).run([&](const Communicator& processes) {
    const Points own = points(rows[processes.rank()], Eigen::indexing::all);
    results[processes.rank()] = detect(own, options, Context({}, 1).sharing(&processes));
  });
  return results;
}

struct Case {
  const char* name;
  int processes;
  Owner owner;
};

// The points in the order of the processes that have them.
Points joined(const Points& points, const std::vector<std::vector<Index>>& rows) {
  std::vector<Index> order;
  for (const std::vector<Index>& own : rows) order.insert(order.end(), own.begin(), own.end());
  return points(order, Eigen::indexing::all);
}

class SharedPoints : public testing::TestWithParam<Case> {};

TEST_P(SharedPoints, GiveThePlaneOfTheWhole) {
  for (unsigned seed = 0; seed < 2; ++seed) {
    const Points points = scan(seed);
    const auto rows = shared_out(points, GetParam().processes, GetParam().owner);
    Options options;
    options.method = "plane";
    const Result whole = detect(joined(points, rows), options, Context({}, 1));
    const double diagonal = (points.colwise().maxCoeff() - points.colwise().minCoeff()).norm();

    const auto& expected = dynamic_cast<const Plane&>(*whole.mirror);
    Index row = 0;
    for (const Result& result : detected(points, rows, options)) {
      const auto& found = dynamic_cast<const Plane&>(*result.mirror);
      const double sign = found.normal().dot(expected.normal()) < 0 ? -1 : 1;
      EXPECT_LT((sign * found.normal() - expected.normal()).norm(), 1e-9);
      EXPECT_NEAR(sign * found.offset(), expected.offset(), 1e-9 * diagonal);
      EXPECT_NEAR(result.score, whole.score, 1e-9);
      EXPECT_EQ(result.statistics.count("outliers"), seed);
      EXPECT_EQ(result.statistics.at("unpaired_points"), whole.statistics.at("unpaired_points"));
      EXPECT_NEAR(std::get<double>(result.statistics.at("mean_residual")),
                  std::get<double>(whole.statistics.at("mean_residual")), 1e-9 * diagonal);
      EXPECT_EQ(result.mirror->mesh().triangles.rows(), whole.mirror->mesh().triangles.rows());
      ASSERT_LE(row + result.pairs.rows(), whole.pairs.rows());
      EXPECT_EQ(result.pairs, whole.pairs.middleRows(row, result.pairs.rows()));
      for (Index i = 0; i < result.pairs.rows(); ++i, ++row)
        ASSERT_NEAR(result.residuals[i], whole.residuals[row], 1e-9 * diagonal);
    }
    EXPECT_EQ(row, whole.pairs.rows());
  }
}

TEST_P(SharedPoints, GiveEveryProcessTheSameBits) {
  const Points points = scan(3);
  Options options;
  options.method = "plane";
  const auto rows = shared_out(points, GetParam().processes, GetParam().owner);
  const std::vector<Result> results = detected(points, rows, options);
  for (const Result& result : results) {
    EXPECT_EQ(result.mirror->numbers(), results.front().mirror->numbers());
    EXPECT_EQ(result.score, results.front().score);
    EXPECT_EQ(result.statistics, results.front().statistics);
  }
}

// Detects on the processes what is the same, to the bit, as on all points, and returns that.
Result found_by_all_alike(const Points& points, const Case& shared, const std::string& method) {
  const auto rows = shared_out(points, shared.processes, shared.owner);
  Options options;
  options.method = method;
  Result whole = detect(joined(points, rows), options, Context({}, 1));
  Index row = 0;
  for (const Result& result : detected(points, rows, options)) {
    EXPECT_EQ(result.mirror->numbers(), whole.mirror->numbers());
    EXPECT_EQ(result.statistics, whole.statistics);
    EXPECT_EQ(result.pairs, whole.pairs.middleRows(row, result.pairs.rows()));
    row += result.pairs.rows();
  }
  EXPECT_EQ(row, whole.pairs.rows());
  return whole;
}

// Where points fill a body, one process extracts the boundary of the whole.
TEST_P(SharedPoints, GiveThePlaneOfAFilledBody) {
  RandomCloud random(5);
  Points points = random.sphere(10000);
  for (auto x : points.rowwise())
    x *= std::cbrt(random.uniform(0, 1)) * (1 + 0.4 * std::sin(3 * x.y() + 1) * x.z());
  const Result whole = found_by_all_alike(points, GetParam(), "plane");
  EXPECT_EQ(whole.statistics.count("boundary_points"), 1u);
}

TEST_P(SharedPoints, GiveTheSphereOfTheWhole) {
  found_by_all_alike(scan(4).topRows(1000), GetParam(), "sphere");
}

// Each process leaves out its own; the numbers of the others go on.
TEST_P(SharedPoints, LeaveOutWhatIsNotFinite) {
  const Points finite = scan(2);
  Points points(finite.rows() + 30, 3);
  for (Index i = 0, next = 0; i < points.rows(); ++i) {
    const bool bad = i % 400 == 3 && i / 400 < 30;
    if (bad)
      points.row(i) << 1, std::numeric_limits<double>::quiet_NaN(), 2;
    else
      points.row(i) = finite.row(next++);
  }
  Options options;
  for (const char* method : {"plane", "sphere"}) {
    options.method = method;
    const Index count = options.method == "plane" ? points.rows() : 1000;
    const Points some = points.topRows(count);
    const auto parts = shared_out(some, GetParam().processes, by_turns);
    const Points together = joined(some, parts);
    const Result whole = detect(together, options, Context({}, 1));
    EXPECT_GT(std::get<Index>(whole.statistics.at("nonfinite_points")), 0);
    Index row = 0;
    for (const Result& result : detected(some, parts, options)) {
      EXPECT_NEAR(result.score, whole.score, 1e-9);
      EXPECT_EQ(result.statistics.at("nonfinite_points"), whole.statistics.at("nonfinite_points"));
      ASSERT_LE(row + result.pairs.rows(), whole.pairs.rows());
      EXPECT_EQ(result.pairs, whole.pairs.middleRows(row, result.pairs.rows()));
      for (Index k = 0; k < result.pairs.rows(); ++k)
        ASSERT_TRUE(together.row(result.pairs(k, 1)).allFinite());
      row += result.pairs.rows();
    }
    EXPECT_EQ(row, whole.pairs.rows());
  }
}

TEST_P(SharedPoints, AreRefusedByAllAlike) {
  Points points = scan(4);
  const auto rows = shared_out(points, GetParam().processes, GetParam().owner);
  std::size_t before = 0;
  for (std::size_t rank = 0; rank + 1 < rows.size(); ++rank) before += rows[rank].size();
  points(rows.back()[7], 1) = std::numeric_limits<double>::quiet_NaN();
  const std::string said = "point " + std::to_string(before + 7) + " is";
  Options options;
  options.method = "plane";
  options.refuse_nonfinite = true;
  ProcessThreads(GetParam().processes).run([&](const Communicator& processes) {
    const Points own = points(rows[processes.rank()], Eigen::indexing::all);
    try {
      detect(own, options, Context().sharing(&processes));
      ADD_FAILURE() << "no error";
    } catch (const InvalidInput& error) {
      EXPECT_EQ(std::string(error.what()).find(said), 0u) << error.what();
    }
  });
}

TEST_P(SharedPoints, OnOneLineAreRefused) {
  Points points(9000, 3);
  for (Index i = 0; i < points.rows(); ++i) points.row(i) << i, 2.0 * i, 1 - 3.0 * i;
  const auto rows = shared_out(points, GetParam().processes, GetParam().owner);
  Options options;
  options.method = "plane";
  ProcessThreads(GetParam().processes).run([&](const Communicator& processes) {
    const Points own = points(rows[processes.rank()], Eigen::indexing::all);
    EXPECT_THROW(detect(own, options, Context().sharing(&processes)), InvalidInput);
  });
}

// Thinned on the way to the root, which finds the mirror; pairs are those of all points.
TEST_P(SharedPoints, ThatAreManyGiveThePlaneOfTheWhole) {
  Points points = scan(GetParam().processes * 2, many);
  points(7, 0) = std::numeric_limits<double>::quiet_NaN();
  const auto rows = shared_out(points, GetParam().processes, GetParam().owner);
  const Points all = joined(points, rows);
  std::vector<std::string> searches{"plane"};
  if (seeds >= seeds_of_the_full_run) searches.push_back("auto");
  for (const std::string& method : searches) {
    Options options;
    options.method = method;
    const std::vector<Result> results = detected(points, rows, options);
    const Result& first = results.front();
    const Plane& found = dynamic_cast<const Plane&>(*first.mirror);
    const Result whole = detect(all, options, Context({}, 1));
    const Plane& expected = dynamic_cast<const Plane&>(*whole.mirror);
    EXPECT_LT(found.normal().cross(expected.normal()).norm(), 1e-3);
    EXPECT_NEAR(first.score, whole.score, 0.01);
    EXPECT_EQ(first.verdict(), "found");
    EXPECT_EQ(first.statistics.at("nonfinite_points"), Value(Index{1}));

    const Result fit = match(all, found, 0.2, Context({}, 1));
    std::map<Index, Index> partner_of;
    for (Index row = 0; row < fit.pairs.rows(); ++row)
      partner_of[fit.pairs(row, 0)] = fit.pairs(row, 1);
    Index count = 0;
    for (const Result& result : results) {
      EXPECT_EQ(result.mirror->numbers(), first.mirror->numbers());
      EXPECT_EQ(result.statistics, first.statistics);
      for (Index row = 0; row < result.pairs.rows(); ++row, ++count)
        ASSERT_EQ(result.pairs(row, 1), partner_of.at(result.pairs(row, 0)));
    }
    EXPECT_NEAR(static_cast<double>(count), static_cast<double>(whole.pairs.rows()), 1e-3 * many);
    EXPECT_EQ(first.statistics.at("unpaired_points"), Value(many - count));
  }
}

TEST_P(SharedPoints, ThatAreManyMayBeInfinite) {
  Points points = scan(4, many);
  points(9, 2) = std::numeric_limits<double>::infinity();
  const auto rows = shared_out(points, GetParam().processes, GetParam().owner);
  for (const Result& result : detected(points, rows, {.method = "plane"})) {
    EXPECT_EQ(result.verdict(), "found");
    EXPECT_EQ(result.statistics.at("nonfinite_points"), Value(Index{1}));
  }
}

TEST_P(SharedPoints, StopTogetherWhenOneIsToldTo) {
  const Points points = scan(6, many);
  const auto rows = shared_out(points, GetParam().processes, GetParam().owner);
  Options options;
  options.method = "plane";
  ProcessThreads(GetParam().processes).run([&](const Communicator& processes) {
    const Points own = points(rows[processes.rank()], Eigen::indexing::all);
    const bool stops = processes.rank() == 1;
    const Context context([&](double fraction) { return !stops || fraction < 0.3; }, 1);
    EXPECT_THROW(detect(own, options, context.sharing(&processes)), Cancelled);
  });
}

INSTANTIATE_TEST_SUITE_P(Processes, SharedPoints,
                         testing::Values(Case{"two_by_turns", 2, by_turns},
                                         Case{"two_by_place", 2, by_place},
                                         Case{"three_by_place", 3, by_place},
                                         Case{"three_never_the_first", 3, never_the_first}),
                         [](const auto& tested) { return std::string(tested.param.name); });

}  // namespace

}  // namespace symsurf::shared_points_tests
