#include "distributed/slabs.h"

#include <gtest/gtest.h>
#include <symsurf/mirrors.h>

#include <algorithm>
#include <functional>
#include <mutex>
#include <numeric>

#include "cloud/cloud.h"
#include "methods/registry.h"
#include "process_threads.h"
#include "random_cloud.h"
#include "score/distributed_matching.h"
#include "score/matching.h"
#include "spatial/nearest_points.h"

namespace symsurf {
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

  void run(const std::function<void(const Cloud&, const Context&)>& body) const {
    const int processes = static_cast<int>(begins.size()) - 1;
    ProcessThreads(processes).run([&](const Communicator& communicator) {
      const Index begin = begins[communicator.rank()], end = begins[communicator.rank() + 1];
      const PointsView own(points.data() + 3 * begin, end - begin);
      const Context context({}, 1);
      Cloud cloud;
      cloud.points = own;
      cloud.partition = Partition(own.size(), &communicator);
      validate(cloud, 4, context);
      body(cloud, context);
    });
  }
};

Slabs slabs_of(const Cloud& cloud, const Vector3& along, const Context& context) {
  return Slabs(cloud.points, cloud.partition, along, cloud.frame.centroid, cloud.diagonal, context);
}

class SharedSlabs : public testing::TestWithParam<int> {};

TEST_P(SharedSlabs, ShareOutThePoints) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    RandomCloud random(seed);
    const Shared shared(random.box(size), GetParam(), random);
    const Vector3 along = random.direction();
    std::vector<int> owners(size);
    std::mutex mutex;
    shared.run([&](const Cloud& cloud, const Context& context) {
      const Slabs slabs = slabs_of(cloud, along, context);
      const Index now = slabs.points().size();
      EXPECT_NEAR(static_cast<double>(now), static_cast<double>(cloud.points.size()), 0.02 * size);
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
  shared.run([&](const Cloud& cloud, const Context& context) {
    const Slabs slabs = slabs_of(cloud, along, context);
    const int here = cloud.partition.processes()->rank();
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
  shared.run([&](const Cloud& cloud, const Context& context) {
    const Slabs slabs = slabs_of(cloud, along, context);
    std::vector<Index> numbers(cloud.points.size(), -1);
    slabs.send_back<Index>([&](Index k) { return slabs.number(k); },
                           [&](Index i, Index number) { numbers[i] = number; });
    for (Index i = 0; i < cloud.points.size(); ++i)
      EXPECT_EQ(numbers[i], cloud.partition.first() + i);
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
      add_pairs(whole, points, PointTree(points), mirror, limit, {});
      for (const Vector3& along : {Vector3(mirror.normal()), mirror.normal().unitOrthogonal()}) {
        Index row = 0;
        std::vector<Result> results(GetParam());
        shared.run([&](const Cloud& cloud, const Context& context) {
          const Slabs slabs = slabs_of(cloud, along, context);
          Result& result = results[cloud.partition.processes()->rank()];
          result.mirror = std::make_shared<Plane>(mirror);
          const ParameterValues values("", {pair_distance(), pairs()},
                                       {{"pair_distance", limit / cloud.diagonal}});
          add_pairs(result, cloud, slabs, PointTree(slabs.points()), values, context);
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

TEST_P(SharedSlabs, HaveTheNearestPointsOfTheWhole) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    RandomCloud random(seed);
    const Shared shared(random.box(size), GetParam(), random);
    const Vector3 along = random.direction();
    const PointTree tree(shared.points);
    const NearestPoints whole(shared.points, tree, {});
    std::vector<Vector3> positions;  // points, and what lies beside the cloud as well
    for (Index i = 0; i < size; i += 10) positions.emplace_back(shared.points.row(i));
    for (int k = 0; k < 100; ++k) positions.push_back(1.5 * random.in_box());
    shared.run([&](const Cloud& cloud, const Context& context) {
      const Slabs slabs = slabs_of(cloud, along, context);
      const PointTree own(slabs.points());
      const NearestPoints points(slabs, own, context);
      EXPECT_EQ(points.second_nearest(positions), whole.second_nearest(positions));
      EXPECT_EQ(points.nearest(positions, 3), whole.nearest(positions, 3));
    });
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
    shared.run([&](const Cloud& cloud, const Context& context) {
      const Slabs slabs = slabs_of(cloud, sign * along, context);
      Index others = 0;
      for (Index k = 0; k < slabs.points().size(); ++k)
        others += slabs.number(k) < cloud.partition.first() ||
                  slabs.number(k) >= cloud.partition.first() + cloud.points.size();
      EXPECT_LT(static_cast<double>(others), 0.02 * size);
    });
}

INSTANTIATE_TEST_SUITE_P(Processes, SharedSlabs, testing::Values(2, 3, 5));

TEST(Slabs, LeaveTheCloudOfOneWhereItLies) {
  RandomCloud random(3);
  const Points points = random.box(size);
  Cloud cloud;
  cloud.points = points;
  cloud.partition = Partition(size);
  const Slabs slabs = slabs_of(cloud, Vector3::UnitX(), {});
  EXPECT_EQ(slabs.points().data(), points.data());
  EXPECT_EQ(slabs.number(7), 7);
}

}  // namespace
}  // namespace symsurf
