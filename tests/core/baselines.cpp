// Planes by the methods of Combes et al., of Nagar and Raman, and of Hruda et al.

#include <gtest/gtest.h>
#include <symsurf/detect.h>
#include <symsurf/mirrors.h>

#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <cmath>
#include <numbers>

#include "base/math.h"
#include "published/published.h"
#include "random_cloud.h"

namespace symsurf::baselines_tests {
namespace {

constexpr double normal_off = 1e-10;  // rounding

// Points of a few kinds of shape, each with its mirror image in x = 0.
Points symmetric_cloud(const std::string& shape, Index count, RandomCloud& random) {
  Points points(count, 3);
  for (Index i = 0; i + 1 < count; i += 2) {
    Vector3 x = random.in_box();
    const Vector3 u = random.direction();
    if (shape == "surface")
      x.x() = 1 + 0.4 * std::sin(3 * x.y() + x.z()) + 0.3 * x.z();
    else if (shape == "ball")
      x = (1 + 0.25 * u.y() * u.z() + 0.3 * std::sin(2 * u.z() + 0.5) * std::abs(u.x()) +
           0.2 * u.y() * u.y() * u.y()) *
          Vector3(u.x(), 1.3 * u.y(), 0.8 * u.z());
    else if (shape == "wedge")  // three faces of a box that no other plane mirrors
      x = i % 3 == 0   ? Vector3(x.x(), 0.7 * x.y(), 0.5 + 0.3 * x.y())
          : i % 3 == 1 ? Vector3(1, 0.7 * x.y(), 0.5 * x.z())
                       : Vector3(x.x(), 0.7, 0.5 * x.z());
    points.row(i) = x.transpose();
    points.row(i + 1) << -x.x(), x.y(), x.z();
  }
  return points;
}

class Baselines : public testing::TestWithParam<const char*> {};

TEST_P(Baselines, FindExactPlanesFromStartsWithin20Degrees) {
  for (const char* shape : {"surface", "ball", "wedge", "volume"})
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
      RandomCloud random(seed);
      const Points points = symmetric_cloud(shape, 1500, random);
      const Matrix3 rotation = random.rotation();
      const Vector3 shift = 3 * random.in_box(), normal = rotation.col(0);
      const double scale = std::exp(random.uniform(-3, 3));
      const Points moved = (scale * points * rotation.transpose()).rowwise() + shift.transpose();
      const double angle = random.uniform(0, 20) * std::numbers::pi / 180;
      const Vector3 axis = normal.cross(random.direction()).normalized();
      const Vector3 start = Eigen::AngleAxisd(angle, axis) * normal;
      const Result result =
          detect(moved, {.method = GetParam(), .parameters = {{"normal", start}}});
      const auto& plane = dynamic_cast<const Plane&>(*result.mirror);
      EXPECT_LE(plane.normal().cross(normal).norm(), normal_off) << shape << " " << seed;
      EXPECT_LE(std::abs(plane.signed_distance(shift)), 1e-10 * scale) << shape << " " << seed;
      EXPECT_EQ(result.score, 1) << shape << " " << seed;
    }
}

TEST_P(Baselines, FindPlanesFromStartsOfTheirOwn) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    RandomCloud random(seed);
    const Points points = symmetric_cloud("surface", 1500, random);
    const Matrix3 rotation = random.rotation();
    const Result result = detect(Points(points * rotation.transpose()), {.method = GetParam()});
    const auto& plane = dynamic_cast<const Plane&>(*result.mirror);
    EXPECT_LE(plane.normal().cross(rotation.col(0)).norm(), normal_off) << seed;
    EXPECT_EQ(result.score, 1) << seed;
  }
}

INSTANTIATE_TEST_SUITE_P(Methods, Baselines, testing::Values("plane_icp", "plane_svd"));

// Tiny clouds in which each point has some partner.
struct Pairs {
  Points points;
  std::vector<Neighbour> partner;
  UnitPlane before;

  explicit Pairs(std::uint64_t seed) {
    RandomCloud random(seed);
    points = random.box(9);
    before = {random.direction(), random.uniform(-0.3, 0.3)};
    for (Index i = 0; i < points.rows(); ++i) {
      Neighbour nearest;
      const Vector3 image = before.reflect(points.row(i).transpose());
      for (Index j = 0; j < points.rows(); ++j)
        nearest = std::min(nearest, {j, (points.row(j).transpose() - image).squaredNorm()});
      partner.push_back(nearest);
    }
  }
  double squared(const UnitPlane& plane, Index i) const {
    return (plane.reflect(points.row(i).transpose()) - points.row(partner[i].index).transpose())
        .squaredNorm();
  }
};

// The least of a cost over planes: a grid over the half sphere, offsets solved by a parabola
// through three, then ever finer about the best.
template <typename Cost>
double least_cost(const Cost& cost) {
  Vector3 best = Vector3::UnitZ();
  double least = infinity;
  const auto try_normal = [&](const Vector3& normal) {
    const double at[] = {cost(UnitPlane{normal, -1}), cost(UnitPlane{normal, 0}),
                         cost(UnitPlane{normal, 1})};
    const double bend = at[0] - 2 * at[1] + at[2], slope = (at[2] - at[0]) / 2;
    const double value = cost(UnitPlane{normal, bend > 0 ? -slope / bend : 0});
    if (value < least) {
      least = value;
      best = normal;
    }
  };
  RandomCloud random(1);
  for (int k = 0; k < 3000; ++k) try_normal(random.direction());
  for (double width = 0.1; width > 1e-6; width *= 0.7)
    for (int k = 0; k < 40; ++k) {
      const Vector3 aside = best + width * random.in_box();
      try_normal(aside.normalized());
    }
  return least;
}

TEST(PlaneIcp, StepLeavesTheLeastWeightedSquares) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const Pairs pairs(seed);
    std::vector<double> squares;
    for (const Neighbour& each : pairs.partner) squares.push_back(each.squared_distance);
    std::sort(squares.begin(), squares.end());
    const double variance = 1.4826 * 1.4826 * squares[4];
    const auto cost = [&](const UnitPlane& plane) {
      double sum = 0;
      for (Index i = 0; i < pairs.points.rows(); ++i)
        sum +=
            std::exp(-pairs.partner[i].squared_distance / (2 * variance)) * pairs.squared(plane, i);
      return sum;
    };
    const UnitPlane next = robust_update({pairs.points, pairs.partner}, pairs.before);
    EXPECT_NEAR(next.normal.norm(), 1, 1e-12);
    const double least = least_cost(cost);
    EXPECT_LE(cost(next), least * (1 + 1e-12)) << seed;
    EXPECT_GE(cost(next), least * (1 - 1e-6)) << seed;
  }
}

TEST(PlaneSvd, StepIsTheBestReflectionOfTheMutualPairs) {
  int with_one_negative = 0;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    const Pairs pairs(seed);
    std::vector<Index> mutual;
    Vector3 middle = Vector3::Zero();
    for (Index i = 0; i < pairs.points.rows(); ++i)
      if (pairs.partner[pairs.partner[i].index].index == i) {
        mutual.push_back(i);
        middle += pairs.points.row(i).transpose();
      }
    const UnitPlane next = mutual_update({pairs.points, pairs.partner}, pairs.before);
    if (mutual.empty()) {
      EXPECT_EQ(next.normal, pairs.before.normal);
      continue;
    }
    middle /= static_cast<double>(mutual.size());
    const Vector3 c = middle - pairs.before.distance(middle) * pairs.before.normal;
    Matrix3 w = Matrix3::Zero();
    for (const Index i : mutual)
      w += (pairs.points.row(pairs.partner[i].index).transpose() - c) *
           (pairs.points.row(i) - c.transpose());
    EXPECT_LE((w - w.transpose()).norm(), 1e-12);
    const auto matrix = [](const Vector3& n) -> Matrix3 {
      return Matrix3::Identity() - 2 * n * n.transpose();
    };
    // The matrix: no other reflection has a greater trace(S W).
    const double trace = (matrix(next.normal) * w).trace();
    RandomCloud random(seed + 100);
    for (int k = 0; k < 2000; ++k)
      EXPECT_LE((matrix(random.direction()) * w).trace(), trace + 1e-12) << seed;
    // Where it is a reflection in a plane, it is U V'.
    const Eigen::JacobiSVD<Eigen::MatrixXd> svd(w, Eigen::ComputeFullU | Eigen::ComputeFullV);
    const Matrix3 s = svd.matrixU() * svd.matrixV().transpose();
    if (svd.singularValues()[2] > 1e-9 && std::abs(s.trace() - 1) < 1e-9) {
      EXPECT_LE((s - matrix(next.normal)).norm(), 1e-9) << seed;
      ++with_one_negative;
    }
    // The offset: the least squares of that normal.
    EXPECT_NEAR(next.distance(middle), 0, 1e-12);
  }
  EXPECT_GT(with_one_negative, 10);
}

// The definition, pair by pair.
double measure_by_definition(const Points& points, const Eigen::Vector4d& p) {
  const Vector3 n = p.head<3>();
  double sum = 0;
  for (Index i = 0; i < points.rows(); ++i) {
    const Vector3 x = points.row(i).transpose();
    const Vector3 image = x - 2 * (n.dot(x) + p[3]) / n.squaredNorm() * n;
    for (Index j = 0; j < points.rows(); ++j)
      sum += wendland((image - points.row(j).transpose()).norm() / measure_reach(points));
  }
  return sum;
}

Eigen::Vector4d random_plane(RandomCloud& random) {
  Eigen::Vector4d p;
  p << random.uniform(0.3, 3) * random.direction(), random.uniform(-0.3, 0.3);
  return p;
}

TEST(PlaneHruda, MeasureIsTheSumOverAllPairs) {
  EXPECT_EQ(wendland(0), 1);
  EXPECT_EQ(wendland(1), 0);
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    RandomCloud random(seed);
    const Points points = random.sphere(300);
    const SymmetryMeasure measure(points);
    const Eigen::Vector4d p = random_plane(random);
    EXPECT_NEAR(measure(p), measure_by_definition(points, p), 1e-10) << seed;
    EXPECT_NEAR(measure(-7 * p), measure(p), 1e-10) << seed;
  }
}

TEST(PlaneHruda, GradientIsTheLimitOfDifferences) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    RandomCloud random(seed);
    const SymmetryMeasure measure(random.sphere(300));
    const Eigen::Vector4d p = random_plane(random);
    Eigen::Vector4d gradient;
    measure(p, gradient);
    for (int k = 0; k < 4; ++k) {
      constexpr double step = 1e-6;
      const Eigen::Vector4d shift = step * Eigen::Vector4d::Unit(k);
      const double difference = (measure(p + shift) - measure(p - shift)) / (2 * step);
      EXPECT_NEAR(gradient[k], difference, 1e-5 * (1 + gradient.norm())) << seed << ' ' << k;
    }
  }
}

// The cells of its thinned cloud do not mirror each other, so that exact planes are not met
// exactly. Not of wedges: of one in eight the best starts lead to another maximum.
TEST(PlaneHruda, FindsPlanesToAShareOfADegree) {
  constexpr double half_a_degree = 0.0087;
  for (const char* shape : {"surface", "ball"})
    for (std::uint64_t seed = 0; seed < seeds; ++seed) {
      RandomCloud random(seed);
      const Points points = symmetric_cloud(shape, 4000, random);
      const Matrix3 rotation = random.rotation();
      const Vector3 shift = 3 * random.in_box();
      const double scale = std::exp(random.uniform(-3, 3));
      const Points moved = (scale * points * rotation.transpose()).rowwise() + shift.transpose();
      const Result result = detect(moved, {.method = "plane_hruda"});
      const auto& plane = dynamic_cast<const Plane&>(*result.mirror);
      EXPECT_LE(plane.normal().cross(rotation.col(0)).norm(), half_a_degree)
          << shape << " " << seed;
      EXPECT_LE(std::abs(plane.signed_distance(shift)), 0.01 * scale) << shape << " " << seed;
    }
}

}  // namespace
}  // namespace symsurf::baselines_tests
