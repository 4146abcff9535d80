#include "surfels.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "../parallel.h"
#include "../point_tree.h"

namespace symsurf {

namespace {

constexpr Index grain = 1 << 16;
constexpr double lattice_shift = 0.38197;
constexpr double line_thinness = 1e-8;  // of the squared width against the squared length
constexpr int finest_cells = 128;       // along the longest side

struct Moments {
  double count = 0;
  Vector3 sum = Vector3::Zero();
  Eigen::Matrix<double, 6, 1> squares = Eigen::Matrix<double, 6, 1>::Zero();

  Moments& operator+=(const Moments& other) {
    count += other.count;
    sum += other.sum;
    squares += other.squares;
    return *this;
  }
  void add(const Vector3& x) {
    ++count;
    sum += x;
    squares[0] += x.x() * x.x();
    squares[1] += x.x() * x.y();
    squares[2] += x.x() * x.z();
    squares[3] += x.y() * x.y();
    squares[4] += x.y() * x.z();
    squares[5] += x.z() * x.z();
  }
  Vector3 mean() const { return sum / count; }
  Matrix3 covariance() const {
    Matrix3 s;
    s << squares[0], squares[1], squares[2], squares[1], squares[3], squares[4], squares[2],
        squares[4], squares[5];
    return s / count - mean() * mean().transpose();
  }
};

struct Thinnest {
  Vector3 direction;
  double flatness;
};

// The direct solver is quick but gives half the digits; one Rayleigh quotient iteration, with the
// adjugate in place of the inverse, gives the rest.
Thinnest thinnest_direction(const Matrix3& covariance) {
  Eigen::SelfAdjointEigenSolver<Matrix3> eigen;
  eigen.computeDirect(covariance);
  const Vector3 rough = eigen.eigenvectors().col(0), spread = eigen.eigenvalues();
  if (!(spread[1] > line_thinness * spread[2])) return {rough, 0};

  const Matrix3 shifted = covariance - rough.dot(covariance * rough) * Matrix3::Identity();
  Matrix3 adjugate;
  adjugate << shifted.col(1).cross(shifted.col(2)), shifted.col(2).cross(shifted.col(0)),
      shifted.col(0).cross(shifted.col(1));
  const Vector3 direction = (adjugate * rough).normalized();
  const double least = std::max(0.0, direction.dot(covariance * direction));
  return {direction, std::max(0.0, 1 - std::sqrt(least / spread[1]))};
}

}  // namespace

Surfels::Surfels(const Cloud& cloud, Index count, const Context& context) : low_(cloud.frame.low) {
  choose_cell(cloud, count, context.stage(0, 0.5));
  sum_moments(cloud, context.stage(0.5, 1));
}

// Sheets fill cells as the square of the resolution, so two or three guesses are enough.
void Surfels::choose_cell(const Cloud& cloud, Index count, const Context& context) {
  const double longest = (cloud.frame.high - cloud.frame.low).maxCoeff();
  const double wanted = static_cast<double>(std::min(count, cloud.points.size()));
  double cells = std::min<double>(finest_cells, 1 + std::sqrt(wanted));
  constexpr int guesses = 4;
  for (int guess = 0; guess < guesses; ++guess) {
    cell_ = longest / cells;
    // Off any lattice that the points may lie on: rounding must not decide between two cells.
    low_ = cloud.frame.low.array() - lattice_shift * cell_;
    size_ = ((cloud.frame.high - low_) / cell_).array().floor().cast<int>() + 1;
    std::vector<std::uint8_t> seen(size_.cast<Index>().prod(), 0);
    for (Index i = 0; i < cloud.points.size(); ++i)
      seen[linear(cell_of(cloud.frame.enter(cloud.points[i])))] = 1;
    const double occupied = static_cast<double>(std::count(seen.begin(), seen.end(), 1));
    context.report((guess + 1.0) / guesses);
    const double better = std::min<double>(finest_cells, cells * std::sqrt(wanted / occupied));
    if (std::abs(occupied / wanted - 1) < 0.15 || std::abs(better - cells) < 0.5) return;
    cells = better;
  }
}

void Surfels::sum_moments(const Cloud& cloud, const Context& context) {
  slot_.assign(size_.cast<Index>().prod(), -1);
  std::vector<Moments> cells;
  std::vector<Cell> places;
  std::vector<Neighbour> samples;
  for (Index i = 0; i < cloud.points.size(); ++i) {
    const Vector3 x = cloud.frame.enter(cloud.points[i]);
    const Cell c = cell_of(x);
    std::int32_t& s = slot_[linear(c)];
    if (s < 0) {
      s = static_cast<std::int32_t>(cells.size());
      cells.emplace_back();
      places.push_back(c);
      samples.emplace_back();
    }
    cells[s].add(x - low_);
    Neighbour& sample = samples[s];
    const Vector3 middle = low_ + cell_ * (c.cast<double>().array() + 0.5).matrix();
    sample = std::min(sample, Neighbour{i, (x - middle).squaredNorm()});
    if (i % grain == 0)
      context.report(static_cast<double>(i) / static_cast<double>(cloud.points.size()));
  }

  // In the order of the cells, not in that of the points.
  surfels_.reserve(cells.size());
  for (const std::int32_t s : slot_) {
    if (s < 0) continue;
    Moments around;
    for (int dx = -1; dx <= 1; ++dx)
      for (int dy = -1; dy <= 1; ++dy)
        for (int dz = -1; dz <= 1; ++dz) {
          const Cell c = places[s] + Cell(dx, dy, dz);
          if ((c.array() < 0).any() || (c.array() >= size_.array()).any()) continue;
          const std::int32_t other = slot_[linear(c)];
          if (other >= 0) around += cells[other];
        }
    const Thinnest thinnest = thinnest_direction(around.covariance());
    surfels_.push_back({low_ + cells[s].mean(), thinnest.direction,
                        thinnest.direction.dot(low_ + around.mean()), thinnest.flatness,
                        samples[s].index});
  }
  std::int32_t next = 0;
  for (std::int32_t& s : slot_)
    if (s >= 0) s = next++;
}

Index Surfels::containing(const Vector3& x) const {
  const Vector3 at = (x - low_) / cell_;
  // Points on the far faces belong to the last cell, as in cell_of.
  if (!((at.array() >= 0).all() && (at.array() <= size_.cast<double>().array()).all())) return -1;
  return slot_[linear(cell_of(x))];
}

const Surfel* flattest_at(std::initializer_list<const Surfels*> scales, const Vector3& x) {
  constexpr double by_chance = 0.1;  // few points look flatter than they are
  const Surfel* flattest = nullptr;
  for (const Surfels* surfels : scales) {
    const Index i = surfels->containing(x);
    if (i < 0) continue;
    const Surfel& surfel = (*surfels)[i];
    if (!flattest || surfel.flatness > flattest->flatness + by_chance) flattest = &surfel;
  }
  return flattest;
}

}  // namespace symsurf
