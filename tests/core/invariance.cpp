#include <gtest/gtest.h>
#include <symsurf/detect.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <numeric>
#include <set>
#include <string>
#include <vector>

#include "random_cloud.h"

namespace symsurf::invariance_tests {
namespace {

struct TestCloud {
  std::string name;
  Points points;
  /// Those that find the same mirror and score; the others, but the thesis's, the same verdict.
  std::vector<std::string> methods;
};

// A bumpy closed surface; with `exact`, each point stands next to its image over x = 0.
Points bumpy(std::uint64_t seed, Index count, bool exact) {
  RandomCloud random(seed);
  Points points(count, 3);
  for (Index i = 0; i < count; ++i) {
    const Vector3 u = random.direction();
    const double radius = 1 + 0.25 * std::sin(3 * u.y() + 1) * std::cos(2 * u.z()) +
                          0.2 * std::sin(4 * u.z()) * u.y();
    Vector3 x = radius * u.cwiseProduct(Vector3(1, 1.5, 0.7));
    if (exact) {
      x.x() = std::abs(x.x());
      if (i % 2) x = points.row(i - 1).transpose().cwiseProduct(Vector3(-1, 1, 1));
    }
    points.row(i) = x.transpose();
  }
  return points;
}

Points lattice(Index columns, Index rows, Index layers) {
  Points points(columns * rows * layers, 3);
  for (Index i = 0; i < points.rows(); ++i)
    points.row(i) << static_cast<double>(i % columns), static_cast<double>(i / columns % rows),
        static_cast<double>(i / columns / rows);
  return points;
}

Points in_box(std::uint64_t seed, Index count, const Vector3& size) {
  return RandomCloud(seed).box(count) * size.asDiagonal();
}

// Each point stands next to its image over the sphere of radius 1.5 about (2, 0, 0), or over the
// cylinder about the line along z through there.
Points about_round_mirror(std::uint64_t seed, Index count, bool cylinder) {
  Points points = bumpy(seed, count, false) * 0.4;
  const Vector3 centre(2, 0, 0);
  for (Index i = 1; i < count; i += 2) {
    const Vector3 x = points.row(i - 1).transpose();
    Vector3 v = x - centre;
    if (cylinder) v.z() = 0;
    points.row(i) = (x + 2 * (1.5 / v.norm() - 1) * v).transpose();
  }
  return points;
}

std::vector<TestCloud> clouds() {
  const std::vector<std::string> anywhere{"auto", "plane", "quadric", "perpendicular"};
  const auto also = [&](const std::string& method) {
    std::vector<std::string> all = anywhere;
    all.push_back(method);
    return all;
  };
  return {
      {"exact", bumpy(1, 600, true), also("fixed_direction")},
      {"random", bumpy(2, 600, false), anywhere},
      {"box", in_box(7, 500, {1, 0.8, 0.5}), anywhere},
      {"lattice", lattice(10, 8, 6), anywhere},
      {"flat lattice", lattice(24, 20, 1), also("fixed_direction")},
      {"coplanar", in_box(3, 400, {1, 0.6, 0}), also("fixed_direction")},
      {"near-collinear", in_box(4, 400, {1000, 1, 1}), also("fixed_direction")},
      {"exact over a sphere", about_round_mirror(5, 600, false), also("sphere")},
      {"exact over a cylinder", about_round_mirror(6, 600, true), also("cylinder")},
  };
}

// Their scores depend on the unit, on the axes or on which of equally near points is the first.
bool is_of_the_thesis(const std::string& method) {
  return method.starts_with("separation") || method == "normals_only" || method == "sphere_thesis";
}

// x -> scale * rotation * x + shift.
struct Similarity {
  Matrix3 rotation = Matrix3::Identity();
  double scale = 1;
  Vector3 shift = Vector3::Zero();

  Points of(const Points& points) const {
    return ((scale * points * rotation.transpose()).rowwise() + shift.transpose()).eval();
  }
  Vector3 of(const Vector3& x) const { return scale * (rotation * x) + shift; }
  Vector3 back(const Vector3& x) const { return rotation.transpose() * ((x - shift) / scale); }
};

double diagonal(const Points& points) {
  return (points.colwise().maxCoeff() - points.colwise().minCoeff()).norm();
}

// The same mirror, by where it sends points of the cloud, and the same score.
void expect_same(const TestCloud& cloud, const std::string& method, const Result& expected,
                 const std::string& change, const Points& changed, const Similarity& by) {
  const std::string what = method + ", " + cloud.name + ", " + change;
  const Result result = detect(changed, {.method = method});
  EXPECT_NEAR(result.score, expected.score, 0.01) << what;
  ASSERT_EQ(result.mirror != nullptr, expected.mirror != nullptr) << what;
  if (!expected.mirror) return;
  double farthest = 0;
  for (Index i = 0; i < cloud.points.rows(); i += 16) {
    const Vector3 x = cloud.points.row(i).transpose();
    const Vector3 image = expected.mirror->reflect(x), other = result.mirror->reflect(by.of(x));
    if (image.allFinite() && other.allFinite())
      farthest = std::max(farthest, (by.back(other) - image).norm());
  }
  EXPECT_LE(farthest, 1e-6 * diagonal(cloud.points)) << what;
}

// In no order.
std::multiset<std::array<double, 3>> rows_of(const Points& points) {
  std::multiset<std::array<double, 3>> rows;
  for (const auto& x : points.rowwise()) rows.insert({x[0], x[1], x[2]});
  return rows;
}

class Invariance : public testing::TestWithParam<TestCloud> {
 protected:
  const TestCloud& cloud = GetParam();
  Matrix3 rotation;
  Points shuffled = cloud.points;

  void SetUp() override {
    RandomCloud random(9);
    rotation = random.rotation();
    for (Index i = shuffled.rows() - 1; i > 0; --i)
      shuffled.row(i).swap(shuffled.row(random.below(i + 1)));
  }
};

TEST_P(Invariance, OfMirrorAndScoreUnderOrderPoseScaleAndCopies) {
  const Points& points = cloud.points;
  const Points twice = shuffled.replicate(2, 1);
  const Similarity moved{rotation, 1e-6, 1e-6 * Vector3(1, -1, 1)};
  for (const std::string& method : cloud.methods) {
    const Result result = detect(points, {.method = method});
    const auto check = [&](const std::string& change, const Similarity& by) {
      expect_same(cloud, method, result, change, by.of(points), by);
    };
    expect_same(cloud, method, result, "all of it", moved.of(twice), moved);
    if (seeds < seeds_of_the_full_run) continue;  // which tells the changes apart
    expect_same(cloud, method, result, "shuffled", shuffled, {});
    expect_same(cloud, method, result, "twice", points.replicate(2, 1), {});
    for (const double scale : {1e-6, 1e6})
      check("turned, scaled by " + std::to_string(scale), {rotation, scale});
    check("scaled by 3.7, shifted", {.scale = 3.7, .shift = Vector3(1e6, -1e6, 1e6)});
  }
}

TEST_P(Invariance, OfTheVerdictOfOtherMethods) {
  const Points twice = shuffled.replicate(2, 1);
  const Similarity turned{.rotation = rotation}, smaller{.scale = 1e-6}, both{rotation, 1e-6};
  for (const Method& method : methods()) {
    const auto& same = cloud.methods;
    if (is_of_the_thesis(method.name) ||
        std::find(same.begin(), same.end(), method.name) != same.end())
      continue;
    const Options options{.method = method.name};
    const std::string verdict = detect(cloud.points, options).verdict();
    std::vector<Points> changes{both.of(twice)};
    if (seeds >= seeds_of_the_full_run)
      changes.insert(changes.end(), {shuffled, turned.of(cloud.points), smaller.of(cloud.points),
                                     Points(cloud.points.replicate(2, 1))});
    for (const Points& changed : changes)
      EXPECT_EQ(detect(changed, options).verdict(), verdict) << method.name << ", " << cloud.name;
  }
}

// What the thesis's methods promise: the same bits of points in any order, and the same anywhere
// where rounding does not tell apart what is equally near.
TEST_P(Invariance, OfTheThesisUnderOrderAndShift) {
  const bool is_lattice = cloud.name.find("lattice") != cloud.name.npos;
  const Similarity shift{.shift = Vector3(1e6, -1e6, 1e6)};
  for (const Method& method : methods()) {
    if (!is_of_the_thesis(method.name)) continue;
    Options options{.method = method.name};
    const bool is_slow = method.name == "sphere_thesis";
    if (is_slow) options.parameters = {{"sample_size", Index{20}}, {"radii", Index{2}}};
    const Result result = detect(cloud.points, options), other = detect(shuffled, options);
    const std::string what = method.name + ", " + cloud.name;
    EXPECT_EQ(other.score, result.score) << what;
    EXPECT_EQ(rows_of(other.surface_points), rows_of(result.surface_points)) << what;
    if (is_slow || is_lattice) continue;
    expect_same(cloud, method.name, result, "shifted", shift.of(cloud.points), shift);
  }
}

TEST(InvarianceOfBits, UnderTheNumberOfThreads) {
  for (const TestCloud& cloud : clouds()) {
    if (cloud.name != "random" && cloud.name != "box" && !cloud.name.starts_with("exact over"))
      continue;
    for (const char* method :
         {"auto", "perpendicular", "quadric", "sphere", "cylinder", "oblique_plane"}) {
      const std::string what = std::string(method) + ", " + cloud.name;
      const auto detected = [&](int threads) {
        return detect(cloud.points, {.method = method}, Context({}, threads));
      };
      const Result one = detected(1), many = detected(3);
      EXPECT_EQ(many.score, one.score) << what;
      EXPECT_EQ(many.candidates.size(), one.candidates.size()) << what;
      EXPECT_EQ(many.pairs, one.pairs) << what;
      EXPECT_EQ(many.residuals, one.residuals) << what;
      EXPECT_EQ(many.surface_points.rows(), one.surface_points.rows()) << what;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Clouds, Invariance, testing::ValuesIn(clouds()), [](const auto& tested) {
  std::string name = tested.param.name;
  for (char& c : name)
    if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
  return name;
});

}  // namespace
}  // namespace symsurf::invariance_tests
