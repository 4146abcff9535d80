#include <gtest/gtest.h>
#include <symsurf/mirrors.h>

#include <algorithm>
#include <functional>
#include <mutex>
#include <numeric>

#include "cloud/cloud.h"
#include "cloud/point_tree.h"
#include "pairing/matching.h"
#include "process_threads.h"
#include "processes/processes.h"
#include "random_cloud.h"
#include "search/methods.h"

namespace symsurf::slabs_tests {
namespace {

constexpr Index size = 5000;

// Points in the order in which processes have them, and where the part of each begins.
struct Shared {
  Points points;
  std::vector<Index> begins;

  // Uneven parts, one of them empty.
  Shared(const Points& whole, int processes, RandomCloud& random) : points(whole), begins{0, 0} {
    for (int k = 2; k < processes; ++k)
      begins.push_back(static_cast<Index>(random.uniform(0, 1) * static_cast<double>(size)));
    std::sort(begins.begin(), begins.end());
    begins.push_back(points.rows());
  }

  void run(const std::function<void(PointsView, const Partition&)>& body) const {
    const int processes = static_cast<int>(begins.size()) - 1;
    ProcessThreads(processes).run([&](const Communicator& communicator) {
      const Index begin = begins[communicator.rank()], end = begins[communicator.rank() + 1];
      const PointsView own(points.data() + 3 * begin, end - begin);
      body(own, Partition(own.size(), communicator));
    });
  }
};

Slabs slabs_of(PointsView own, const Partition& partition, const Vector3& along) {
  return Slabs(own, partition, along, Vector3(0.1, 0.2, 0.3), 3, Context({}, 1));
}

class SharedSlabs : public testing::TestWithParam<int> {};

TEST_P(SharedSlabs, ShareOutThePoints) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    RandomCloud random(seed);
    const Shared shared(random.box(size), GetParam(), random);
    const Vector3 along = random.direction();
    std::vector<int> owners(size);
    std::mutex mutex;
    shared.run([&](PointsView own, const Partition& partition) {
      const Slabs slabs = slabs_of(own, partition, along);
      const Index now = slabs.points().size();
      EXPECT_NEAR(static_cast<double>(now), static_cast<double>(own.size()), 0.02 * size);
      const std::scoped_lock lock(mutex);
      for (Index k = 0; k < now; ++k) {
        ++owners[slabs.number(k)];
        EXPECT_EQ(slabs.points()[k], PointsView(shared.points)[slabs.number(k)]);
        if (k == 0) continue;
        EXPECT_LT(slabs.number(k - 1), slabs.number(k));
      }
    });
    EXPECT_EQ(std::count(owners.begin(), owners.end(), 1), size);
  }
}

TEST_P(SharedSlabs, AreNoNearerThanTheySay) {
  RandomCloud random(1);
  const Shared shared(random.box(size), GetParam(), random);
  const Vector3 along = random.direction();
  const Points positions = 2 * random.box(50);
  shared.run([&](PointsView own, const Partition& partition) {
    const Slabs slabs = slabs_of(own, partition, along);
    const int here = partition.processes().rank();
    for (Index k = 0; k < slabs.points().size(); ++k) {
      EXPECT_EQ(slabs.distance(slabs.points()[k], here), 0);
      for (Index q = 0; q < positions.rows(); ++q) {
        const Vector3 position = positions.row(q);
        ASSERT_LE(slabs.distance(position, here), (slabs.points()[k] - position).norm());
      }
    }
  });
}

TEST_P(SharedSlabs, SendBackToTheProcessThatHadThePoint) {
  RandomCloud random(2);
  const Shared shared(random.box(size), GetParam(), random);
  const Vector3 along = random.direction();
  shared.run([&](PointsView own, const Partition& partition) {
    const Slabs slabs = slabs_of(own, partition, along);
    std::vector<Index> numbers(own.size(), -1);
    slabs.send_back<Index>([&](Index k) { return slabs.number(k); },
                           [&](Index i, Index number) { numbers[i] = number; });
    for (Index i = 0; i < own.size(); ++i) EXPECT_EQ(numbers[i], partition.first() + i);
  });
}

// Whether partners are in the same slab, as the method has it, or all in another.
TEST_P(SharedSlabs, HaveThePartnersOfTheWhole) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    RandomCloud random(seed);
    const Plane mirror(Vector3(1, 2, 2) / 3, -1);
    for (const Points& points : {random.box(size), random.lattice(size, 9)}) {
      const Shared shared(points, GetParam(), random);
      const double limit = random.uniform(0.02, 0.1);
      Result whole;
      add_pairs(whole, Cloud(points), mirror, limit, {});
      for (const Vector3& along : {Vector3(mirror.normal()), mirror.normal().unitOrthogonal()}) {
        Index row = 0;
        std::vector<Result> results(GetParam());
        shared.run([&](PointsView own, const Partition& partition) {
          const Slabs slabs = slabs_of(own, partition, along);
          Result& result = results[partition.processes().rank()];
          result.mirror = std::make_shared<Plane>(mirror);
          add_pairs(result, own, slabs, PointTree(slabs.points()), limit, Context({}, 1));
        });
        for (const Result& result : results) {
          const Index rows = result.pairs.rows();
          ASSERT_LE(row + rows, whole.pairs.rows());
          EXPECT_EQ(result.pairs, whole.pairs.middleRows(row, rows));
          // To rounding: trees measure from their own points' middle.
          EXPECT_LT((result.residuals - whole.residuals.segment(row, rows)).norm(), 1e-12);
          EXPECT_EQ(result.surface_points, whole.surface_points.middleRows(row, rows));
          row += rows;
        }
        EXPECT_EQ(row, whole.pairs.rows());
      }
    }
  }
}

// Whichever way they were.
TEST_P(SharedSlabs, StayWhereTheyAreSlabsAlready) {
  RandomCloud random(4);
  Points points = random.box(size);
  const Vector3 along = random.direction();
  std::vector<Index> order(size);
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(),
            [&](Index a, Index b) { return points.row(a).dot(along) < points.row(b).dot(along); });
  const Shared shared(points(order, Eigen::indexing::all), GetParam(), random);
  for (const double sign : {-1, 1})
    shared.run([&](PointsView own, const Partition& partition) {
      const Slabs slabs = slabs_of(own, partition, sign * along);
      Index others = 0;
      for (Index k = 0; k < slabs.points().size(); ++k)
        others += slabs.number(k) < partition.first() ||
                  slabs.number(k) >= partition.first() + own.size();
      EXPECT_LT(static_cast<double>(others), 0.02 * size);
    });
}

INSTANTIATE_TEST_SUITE_P(Processes, SharedSlabs, testing::Values(2, 3, 5));

}  // namespace
}  // namespace symsurf::slabs_tests
