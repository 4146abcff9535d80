#include "score/cloud_halves.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "base/math.h"
#include "base/random.h"

namespace symsurf {

namespace {

constexpr Index most_points = 32768;  // drawn of larger clouds: some in each of the least cells
constexpr double least_cell = 0.01;   // diagonals: some forty in the smallest ball on a surface
constexpr Index neighbours = 7;
constexpr double sparse = 0.9;  // quantile
// Where the density differs a cell of the sparse part must not be empty by chance, as few of the
// dense are: e^-2.5 are. `by_chance`: that quantile over the opposite one in points spread at
// random.
constexpr double by_chance = 1.72, most_wider = 1.6;

// A point under a random key, which is the same wherever it stands in the cloud's order and however
// the cloud is turned: a cell of 2^-16 diagonals holds it before and after rounding.
struct Drawn {
  std::uint64_t key;
  Vector3 x;
  bool operator<(const Drawn& other) const {
    return key != other.key
               ? key < other.key
               : std::lexicographical_compare(x.begin(), x.end(), other.x.begin(), other.x.end());
  }
  bool operator==(const Drawn& other) const { return key == other.key; }
};

std::uint64_t key_of(const Vector3& x, std::size_t split) {
  std::uint64_t key = split;
  for (const double coordinate : x)
    key = Random(key ^ static_cast<std::uint64_t>(std::llround(coordinate * 0x1p16))).bits();
  return key;
}

std::vector<Drawn> drawn_points(const Cloud& cloud, const Surfels& surface, std::size_t split) {
  const double share =
      std::min(1.0, static_cast<double>(most_points) / static_cast<double>(cloud.points.size()));
  const auto most_key = static_cast<std::uint64_t>(share * 0x1p63);
  std::vector<Drawn> all;
  for (Index i = 0; i < cloud.points.size(); ++i) {
    const Vector3 x = cloud.frame.to_frame(cloud.points[i]);
    if (const std::uint64_t key = key_of(x, split);
        key >> 1 <= most_key && surface.containing(x) >= 0)
      all.push_back({key, x});
  }
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
}

Points every_other(const std::vector<Drawn>& drawn, std::size_t first) {
  Points points(static_cast<Index>((drawn.size() + 1 - first) / 2), 3);
  for (Index i = 0; i < points.rows(); ++i)
    points.row(i) = drawn[first + 2 * static_cast<std::size_t>(i)].x.transpose();
  return points;
}

// As wide as the seven nearest points lie where they are sparse: on a surface, each cell has some.
// Asked for all over the surface, of which a sparse part has few points.
double cell_of(const Points& points, const Surfels& surface) {
  const PointTree tree(points);
  std::vector<double> reach;
  std::vector<Neighbour> nearest;
  for (Index k = 0; k < surface.size(); ++k) {
    tree.nearest(surface[k].sampled, neighbours, nearest);
    if (!nearest.empty()) reach.push_back(std::sqrt(nearest.back().squared_distance));
  }
  if (reach.empty()) return least_cell;
  const double disc = std::sqrt((neighbours - 1) / std::numbers::pi);  // spacings that it reaches
  const double dense = quantile(reach, 1 - sparse), widest = quantile(std::move(reach), sparse);
  const double wider = dense > 0 ? std::clamp(widest / (by_chance * dense), 1.0, most_wider) : 1;
  return std::max(least_cell, wider * widest / disc);
}

Points cell_means(const Points& points, double cell) {
  struct Entry {
    std::int64_t x, y, z;
    Index row;
    auto operator<=>(const Entry&) const = default;
  };
  std::vector<Entry> entries;
  // Off any lattice that the points may lie on: rounding must not decide between two cells.
  const auto in_cells = [&](double v) {
    return static_cast<std::int64_t>(std::floor(v / cell + 0.38197));
  };
  for (Index i = 0; i < points.rows(); ++i)
    entries.push_back({in_cells(points(i, 0)), in_cells(points(i, 1)), in_cells(points(i, 2)), i});
  std::sort(entries.begin(), entries.end());
  std::vector<Vector3> means;
  for (std::size_t begin = 0, end; begin < entries.size(); begin = end) {
    Vector3 sum = Vector3::Zero();
    for (end = begin; end < entries.size() && entries[end].x == entries[begin].x &&
                      entries[end].y == entries[begin].y && entries[end].z == entries[begin].z;
         ++end)
      sum += points.row(entries[end].row).transpose();
    means.push_back(sum / static_cast<double>(end - begin));
  }
  return rows_of(means);
}

// On a grid that no symmetry of the principal frame maps onto the other's.
Points turned_cell_means(const Points& points, double cell) {
  const Matrix3 turn = Eigen::AngleAxisd(1, Vector3(1, 2, 3).normalized()).toRotationMatrix();
  return cell_means(points * turn, cell) * turn.transpose();
}

}  // namespace

struct CloudHalves::Split {
  Split(const std::vector<Drawn>& drawn, const Surfels& surface)
      : one(every_other(drawn, 0)), two(every_other(drawn, 1)), cell(cell_of(one, surface)) {}
  Points one, two;
  double cell;
};

CloudHalves::CloudHalves(const Cloud& cloud, const Surfels& surface, std::size_t split)
    : CloudHalves(Split(drawn_points(cloud, surface, split), surface)) {}

CloudHalves::CloudHalves(const Split& split)
    : cell(split.cell), one(cell_means(split.one, cell)), two(turned_cell_means(split.two, cell)) {}

namespace {

constexpr double penalty = 1.2;  // of the worst miss
constexpr double least = 3;      // points that span a plane
// Shares of the points: fewer on one side are a rim, as many are there by chance.
constexpr double strip = 0.5, whole = 0.7;

double squared(double x) { return x * x; }

}  // namespace

Ball::Ball(const ThinnedHalf& set, const Vector3& centre, double radius) {
  double weights = 0, squares = 0;
  Matrix3 products = Matrix3::Zero();  // its lower triangle
  const double per_squared = 1 / squared(radius);
  set.tree.within(centre, radius, [&](Index i, double squared_distance) {
    const double weight = 1 - squared_distance * per_squared;
    const Vector3 offset = set.points.row(i).transpose() - centre, weighted = weight * offset;
    ++count;
    weights += weight;
    squares += squared(weight);
    mean += weighted;
    for (int row = 0; row < 3; ++row)
      for (int column = 0; column <= row; ++column)
        products(row, column) += weighted[row] * offset[column];
  });
  if (!(weights > 0)) return;
  effective = squared(weights) / squares;
  mean /= weights;
  Matrix3 covariance = products.selfadjointView<Eigen::Lower>();
  covariance = covariance / weights - mean * mean.transpose();
  Eigen::SelfAdjointEigenSolver<Matrix3> solver;
  solver.computeDirect(covariance);
  variances = solver.eigenvalues().cwiseMax(0);
  axes = solver.eigenvectors();
  // Of points that fill the ball, weighted like these.
  const double filled = squared(radius) / 7;
  constexpr double thin = 0.25, thick = 0.5;
  thinness = ((thick - variances.array() / filled) / (thick - thin)).cwiseMax(0).cwiseMin(1);
  const bool is_line = variances[1] <= 0.02 * variances[2];
  flatness = is_line ? 0 : 1 - std::sqrt(variances[0] / variances[1]);
}

Ball Ball::moved(const Matrix3& linear) const {
  Ball ball = *this;
  ball.mean = linear * mean;
  ball.axes = linear * axes;
  return ball;
}

BallSupport::BallSupport(const Ball& own, const Ball& other, const Tolerance& tolerance) {
  if (other.count < least || own.count < least) {
    (other.count < least ? missing : rim) = 1;
    return;
  }
  const Vector3 gap = own.mean - other.mean;
  // Less twice the variance that few points leave to the gap.
  const auto across = [&](const Ball& ball) {
    const Vector3 along = ball.axes.transpose() * gap;
    const Vector3 left = along.cwiseAbs2() - 4 / ball.effective * ball.variances;
    return ball.thinness.dot(left);
  };
  // At a rim, where one ball holds but a strip, the other shows which way the surface goes.
  const double one = across(own), two = across(other);
  const auto [less, more] = std::minmax(own.count, other.count);
  const double of_whole = more == other.count ? two : one;
  const double shared = std::clamp((less / more - strip) / (whole - strip), 0.0, 1.0);
  const double offset = std::max(0.0, shared * std::max(one, two) + (1 - shared) * of_whole);
  const double complete = std::min(1.0, less / (whole * more));
  const double cosine = own.normal().dot(other.normal());
  const double turned = own.flatness * other.flatness * (1 - squared(cosine));
  const double missed = offset / squared(tolerance.far);
  support = complete * (squared(1 - turned) / (1 + offset / squared(tolerance.near)) -
                        penalty * missed * std::exp(1 - missed));
  (more == other.count ? rim : missing) = 1 - complete;
  apart = std::sqrt(offset);
}

}  // namespace symsurf
