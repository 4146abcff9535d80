#include <gtest/gtest.h>
#include <symsurf/analyses.h>
#include <symsurf/context.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <string>
#include <vector>

#include "expect_error.h"
#include "random_cloud.h"

namespace symsurf::recurring_parts_tests {
namespace {

// Triangles that share no points, as STL files have them.
class Soup {
 public:
  explicit Soup(RandomCloud& random) : random_(random) {}

  void add(const Vector3& a, const Vector3& b, const Vector3& c) {
    for (const Vector3& x : {a, b, c}) corners_.push_back(x);
  }

  /// Four triangles about a point that lies anywhere in the middle.
  void quad(const Vector3& a, const Vector3& b, const Vector3& c, const Vector3& d) {
    const double u = random_.uniform(0.3, 0.7), v = random_.uniform(0.3, 0.7);
    const Vector3 middle = (1 - v) * ((1 - u) * a + u * b) + v * ((1 - u) * d + u * c);
    add(a, b, middle);
    add(b, c, middle);
    add(c, d, middle);
    add(d, a, middle);
  }

  /// The walls between two closed polylines.
  void walls(const std::vector<Vector3>& one, const std::vector<Vector3>& other) {
    for (std::size_t k = 0; k < one.size(); ++k) {
      const std::size_t next = (k + 1) % one.size();
      quad(one[k], one[next], other[next], other[k]);
    }
  }

  /// Triangles about a point.
  void fan(const std::vector<Vector3>& around, const Vector3& middle) {
    for (std::size_t k = 0; k < around.size(); ++k)
      add(around[k], around[(k + 1) % around.size()], middle);
  }

  void add(const Soup& other, const Eigen::Affine3d& map) {
    for (const Vector3& x : other.corners_) corners_.push_back(map * x);
  }

  Index size() const { return static_cast<Index>(corners_.size()); }

  Points points() const {
    Points rows(size(), 3);
    for (Index i = 0; i < size(); ++i) rows.row(i) = corners_[i].transpose();
    return rows;
  }

 private:
  RandomCloud& random_;
  std::vector<Vector3> corners_;
};

Triangles faces_of(Index points) {
  Triangles faces(points / 3, 3);
  for (Index i = 0; i < points; ++i) faces(i / 3, i % 3) = i;
  return faces;
}

AnalysisResult recurring_parts(const Points& points, const Context& context = {},
                               double tolerance = 0.002) {
  const Triangles faces = faces_of(points.rows());
  AnalysisOptions options;
  options.parameters["tolerance"] = tolerance;
  options.faces = faces;
  return analyse("recurring_parts", points, options, context);
}

Eigen::Affine3d random_motion(RandomCloud& random, bool reflects) {
  Eigen::Affine3d map;
  map.linear() = random.rotation();
  if (reflects) map.linear().col(0) *= -1;
  map.translation() = 10 * random.in_box();
  return map;
}

Points moved(const Points& points, const Eigen::Affine3d& map) {
  return (points * map.linear().transpose()).rowwise() + map.translation().transpose();
}

std::vector<Vector3> rectangle(double x0, double x1, double y0, double y1, double z) {
  return {{x0, y0, z}, {x1, y0, z}, {x1, y1, z}, {x0, y1, z}};
}

struct Labelled {
  Points points;
  std::vector<int> label;  // of each point the window or tooth, -1: none, or at an end of one
};

// 0, then where each of so many things begins and ends, at uneven distances, then the end of all.
std::vector<double> spread(RandomCloud& random, int count, double size) {
  std::vector<double> lines{0};
  for (int k = 0; k < count; ++k) {
    lines.push_back(lines.back() + random.uniform(0.3, 0.9));
    lines.push_back(lines.back() + size);
  }
  lines.push_back(lines.back() + random.uniform(0.3, 0.9));
  return lines;
}

// An open wall with recessed windows.
Labelled facade(RandomCloud& random, int columns, int rows) {
  const double width = random.uniform(0.8, 1.2), height = random.uniform(1.3, 2),
               depth = random.uniform(0.1, 0.3);
  const std::vector<double> x = spread(random, columns, width), y = spread(random, rows, height);
  Soup soup(random);
  Labelled wall;
  const auto label = [&](int number) { wall.label.resize(soup.size(), number); };
  for (std::size_t i = 0; i + 1 < x.size(); ++i)
    for (std::size_t j = 0; j + 1 < y.size(); ++j) {
      const auto outer = rectangle(x[i], x[i + 1], y[j], y[j + 1], 0);
      if (i % 2 == 0 || j % 2 == 0) {
        soup.quad(outer[0], outer[1], outer[2], outer[3]);
        label(-1);
        continue;
      }
      const auto inner = rectangle(x[i], x[i + 1], y[j], y[j + 1], -depth);
      soup.walls(outer, inner);
      soup.quad(inner[0], inner[1], inner[2], inner[3]);
      label(static_cast<int>(i / 2 + columns * (j / 2)));
    }
  wall.points = soup.points();
  return wall;
}

// A gear with straight flanks; its teeth are its tips and flanks.
Labelled gear(RandomCloud& random, int teeth) {
  const double root = random.uniform(0.7, 0.85), thickness = random.uniform(0.2, 0.6);
  std::vector<Vector3> low, high;
  const double phases[] = {0, 0.2, 0.45, 0.65}, radii[] = {root, 1, 1, root};
  for (int tooth = 0; tooth < teeth; ++tooth)
    for (int k = 0; k < 4; ++k) {
      const double angle = 2 * std::numbers::pi * (tooth + phases[k]) / teeth;
      low.emplace_back(radii[k] * std::cos(angle), radii[k] * std::sin(angle), 0);
      high.push_back(low.back() + thickness * Vector3::UnitZ());
    }
  Soup soup(random);
  soup.walls(low, high);
  soup.fan(low, Vector3::Zero());
  soup.fan(high, thickness * Vector3::UnitZ());
  Labelled wheel{soup.points(), {}};
  for (Index i = 0; i < wheel.points.rows(); ++i) {
    const Eigen::Vector2d x = wheel.points.row(i).head<2>();
    double angle = std::atan2(x.y(), x.x()) / (2 * std::numbers::pi);
    if (angle < 0) angle += 1;
    const double phase = teeth * angle, within = phase - std::floor(phase);
    const bool is_tip = x.norm() > (1 + root) / 2 && within > 0.1 && within < 0.55;
    wheel.label.push_back(is_tip ? static_cast<int>(phase) : -1);
  }
  return wheel;
}

// That the first part has one instance of each label, and that the maps take the first to them.
void expect_instances(const Labelled& shape, const AnalysisResult& result, int count) {
  ASSERT_EQ(std::get<Index>(result.statistics.at("parts")), 1);
  ASSERT_EQ(result.transformations.size(), static_cast<std::size_t>(count));
  std::vector<int> found;
  const double near = 1e-9 * (shape.points.colwise().maxCoeff().norm() + 1);
  for (int k = 0; k < count; ++k) {
    const Transformation& map = result.transformations[k];
    int label = -1;
    for (const Index i : map.onto)
      if (shape.label[i] >= 0) {
        if (label < 0) label = shape.label[i];
        EXPECT_EQ(shape.label[i], label) << k;
      }
    found.push_back(label);
    EXPECT_GT(map.score, 0.99);
    EXPECT_EQ(map.kind == "identity", k == 0);
  }
  std::sort(found.begin(), found.end());
  for (int k = 0; k < count; ++k) EXPECT_EQ(found[k], k);
  // Corners land on corners: the soup has the middles of its faces anywhere.
  for (const Transformation& map : result.transformations) {
    Index landed = 0;
    for (const Index i : map.from) {
      const Vector3 image = (map.matrix * Vector3(shape.points.row(i)).homogeneous()).head<3>();
      landed += std::any_of(map.onto.begin(), map.onto.end(), [&](Index j) {
        return (Vector3(shape.points.row(j)) - image).norm() < near;
      });
    }
    EXPECT_GE(landed, 16);
  }
}

TEST(RecurringParts, AreTheWindowsOfAFacade) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    SCOPED_TRACE(seed);
    RandomCloud random(seed);
    Labelled wall = facade(random, 6, 4);
    wall.points = moved(wall.points, random_motion(random, seed % 2));
    expect_instances(wall, recurring_parts(wall.points), 24);
  }
}

TEST(RecurringParts, AreTheTeethOfAGear) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed)
    for (const int teeth : {7, 24}) {
      SCOPED_TRACE(seed);
      RandomCloud random(seed);
      Labelled wheel = gear(random, teeth);
      wheel.points = moved(wheel.points, random_motion(random, seed % 2));
      expect_instances(wheel, recurring_parts(wheel.points), teeth);
    }
}

Soup tetrahedron(RandomCloud& random) {
  std::vector<Vector3> x;
  for (const Vector3& corner :
       {Vector3(0, 0, 0), Vector3(1, 0, 0), Vector3(0, 1.5, 0), Vector3(0, 0, 2)})
    x.push_back(corner + 0.1 * random.in_box());
  Soup soup(random);
  for (int k = 0; k < 4; ++k) soup.add(x[k], x[(k + 1) % 4], x[(k + 2) % 4]);
  return soup;
}

TEST(RecurringParts, AreTurnedAndReflectedCopiesAmongOthers) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    SCOPED_TRACE(seed);
    RandomCloud random(seed);
    const Soup one = tetrahedron(random);
    Soup scene(random);
    std::vector<Eigen::Affine3d> maps;
    for (int k = 0; k < 5; ++k) {
      maps.push_back(random_motion(random, k % 2));
      maps.back().translation() = Vector3(6 * k, 0, 0);
      scene.add(one, maps.back());
      Eigen::Affine3d apart = random_motion(random, false);
      apart.translation() = Vector3(6 * k, 6, 0);
      scene.add(tetrahedron(random), apart);
    }
    const AnalysisResult result = recurring_parts(scene.points(), {}, 2e-4);
    ASSERT_EQ(result.transformations.size(), 5u);
    for (const Transformation& found : result.transformations) {
      // From the one that happens to come first.
      const bool is_planted = std::any_of(maps.begin(), maps.end(), [&](const auto& from) {
        return std::any_of(maps.begin(), maps.end(), [&](const auto& onto) {
          return ((onto * from.inverse()).matrix() - found.matrix).norm() < 1e-9;
        });
      });
      EXPECT_TRUE(is_planted) << found.matrix;
      EXPECT_EQ(found.onto.size(), 12u);
    }
  }
}

// A bar with the rims of its ends, which have any number of sides.
Soup round_bar(RandomCloud& random, double radius, double length) {
  const Index sides = 30 + random.below(30);
  std::vector<Vector3> low, high;
  for (Index k = 0; k < sides; ++k) {
    const double angle = 2 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(sides);
    low.emplace_back(radius * std::cos(angle), radius * std::sin(angle), 0);
    high.push_back(low.back() + length * Vector3::UnitZ());
  }
  Soup soup(random);
  soup.walls(low, high);
  soup.fan(low, Vector3::Zero());
  soup.fan(high, length * Vector3::UnitZ());
  return soup;
}

TEST(RecurringParts, AreRoundBarsOfOneSize) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    RandomCloud random(seed);
    Soup scene(random);
    for (int k = 0; k < 6; ++k) {
      scene.add(round_bar(random, 0.5, 2), random_motion(random, false));
      if (k % 2 == 0) scene.add(round_bar(random, 0.5, 1), random_motion(random, false));
    }
    const AnalysisResult result = recurring_parts(scene.points());
    EXPECT_EQ(std::get<Index>(result.statistics.at("parts")), 2) << seed;
    EXPECT_EQ(result.transformations.size(), 9u) << seed;
  }
}

TEST(RecurringParts, AreNoneOfASingleBody) {
  RandomCloud random(0);
  Soup box(random), ball(random);
  const auto low = rectangle(0, 3, 0, 2, 0), high = rectangle(0, 3, 0, 2, 1);
  box.walls(low, high);
  for (const auto& face : {low, high}) box.quad(face[0], face[1], face[2], face[3]);
  constexpr int sides = 40;
  std::vector<Vector3> ring, above;
  for (int row = 0; row <= sides / 2; ++row) {
    above.clear();
    const double height = 2 * std::numbers::pi * row / sides;
    for (int k = 0; k < sides; ++k) {
      const double angle = 2 * std::numbers::pi * k / sides;
      above.emplace_back(std::sin(height) * std::cos(angle), std::sin(height) * std::sin(angle),
                         std::cos(height));
    }
    if (row > 0) ball.walls(ring, above);
    ring = above;
  }
  for (const Soup& body : {box, ball, tetrahedron(random), round_bar(random, 1, 2)}) {
    const AnalysisResult result = recurring_parts(body.points());
    EXPECT_TRUE(result.transformations.empty());
    EXPECT_TRUE((result.arrays.at("part").array() == -1).all());
  }
}

TEST(RecurringParts, AreTheSameInAnyOrderAndByAnyNumberOfThreads) {
  RandomCloud random(1);
  const Labelled wall = facade(random, 3, 2);
  const Index count = wall.points.rows();
  const AnalysisResult one = recurring_parts(wall.points, Context(nullptr, 1)),
                       three = recurring_parts(wall.points, Context(nullptr, 3)),
                       back = recurring_parts(wall.points.colwise().reverse());
  ASSERT_EQ(one.transformations.size(), 6u);
  for (std::size_t k = 0; k < 6; ++k) {
    EXPECT_EQ(one.transformations[k].matrix, three.transformations[k].matrix);
    EXPECT_EQ(one.transformations[k].onto, three.transformations[k].onto);
  }
  EXPECT_EQ(one.arrays.at("instance"), three.arrays.at("instance"));
  // Any window may come first, but what belongs together does.
  for (Index i = 1; i < count; ++i) {
    const auto together = [&](const AnalysisResult& result, Index a, Index b) {
      const Eigen::MatrixXd& instance = result.arrays.at("instance");
      return instance(a, 0) == instance(b, 0);
    };
    EXPECT_EQ(together(one, i, i - 1), together(back, count - 1 - i, count - i));
  }
}

// So many points of a soup's triangles, uniform over their area.
Labelled cloud_of(const Labelled& soup, Index count, RandomCloud& random) {
  const auto corner = [&](Index i) { return Vector3(soup.points.row(i)); };
  std::vector<double> area{0};
  for (Index i = 0; i < soup.points.rows(); i += 3)
    area.push_back(area.back() +
                   (corner(i + 1) - corner(i)).cross(corner(i + 2) - corner(i)).norm());
  Labelled cloud{Points(count, 3), {}};
  for (Index k = 0; k < count; ++k) {
    const auto above = std::upper_bound(area.begin(), area.end(), random.uniform(0, area.back()));
    const Index i = 3 * (above - area.begin() - 1);
    const double u = std::sqrt(random.uniform(0, 1)), v = random.uniform(0, 1);
    cloud.points.row(k) =
        ((1 - u) * corner(i) + u * (1 - v) * corner(i + 1) + u * v * corner(i + 2)).transpose();
    cloud.label.push_back(soup.label[i]);
  }
  return cloud;
}

AnalysisResult recurring_parts_of_cloud(const Points& points, const Context& context = {}) {
  return analyse("recurring_parts", points, {}, context);
}

TEST(RecurringParts, OfACloudAreWindowsToo) {
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    SCOPED_TRACE(seed);
    RandomCloud random(seed);
    Labelled wall = cloud_of(facade(random, 3, 2), 60000, random);
    wall.points = moved(wall.points, random_motion(random, seed % 2));
    const AnalysisResult result = recurring_parts_of_cloud(wall.points);
    ASSERT_EQ(std::get<Index>(result.statistics.at("parts")), 1);
    std::vector<int> found;
    for (const Transformation& map : result.transformations) {
      std::vector<Index> points_of(6, 0);
      for (const Index i : map.onto)
        if (wall.label[i] >= 0) ++points_of[wall.label[i]];
      const auto most = std::max_element(points_of.begin(), points_of.end());
      EXPECT_GT(*most, 1000);
      EXPECT_EQ(*most, std::accumulate(points_of.begin(), points_of.end(), Index{0}));
      found.push_back(static_cast<int>(most - points_of.begin()));
      EXPECT_EQ(map.kind, found.size() == 1 ? "identity" : "translation");
      EXPECT_GT(map.score, 0.9);
    }
    std::sort(found.begin(), found.end());
    EXPECT_EQ(found, (std::vector<int>{0, 1, 2, 3, 4, 5}));
  }
}

TEST(RecurringParts, OfACloudAreTheSameByAnyNumberOfThreads) {
  RandomCloud random(0);
  const Points points = cloud_of(facade(random, 3, 2), 60000, random).points;
  const AnalysisResult one = recurring_parts_of_cloud(points, Context(nullptr, 1)),
                       three = recurring_parts_of_cloud(points, Context(nullptr, 3));
  ASSERT_EQ(one.transformations.size(), 6u);
  for (std::size_t k = 0; k < 6; ++k)
    EXPECT_EQ(one.transformations[k].matrix, three.transformations[k].matrix);
  EXPECT_EQ(one.arrays.at("instance"), three.arrays.at("instance"));
}

TEST(RecurringParts, AreNoneOfCloudsWithoutThem) {
  Points copies(2000, 3);
  for (Index i = 0; i < copies.rows(); ++i) copies.row(i) = Vector3(i % 20, i % 20 % 3, 0);
  int found = 0;
  for (std::uint64_t seed = 0; seed < slow_seeds; ++seed) {
    RandomCloud random(seed);
    for (const Points& points : {random.box(20000), random.sphere(20000), random.box(4), copies})
      EXPECT_TRUE(recurring_parts_of_cloud(points).transformations.empty()) << seed;
    // A lattice whose corners are taken by chance has planes with chance outlines.
    found += recurring_parts_of_cloud(random.lattice(8000, 20)).transformations.empty() ? 0 : 1;
  }
  EXPECT_LE(found, 1);
}

}  // namespace
}  // namespace symsurf::recurring_parts_tests
