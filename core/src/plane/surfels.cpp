#include "surfels.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "../gathered.h"
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
  double flatness, thickness, width;
};

// The direct solver is quick but gives half the digits; one Rayleigh quotient iteration, with the
// adjugate in place of the inverse, gives the rest.
Thinnest thinnest_direction(const Matrix3& covariance) {
  Eigen::SelfAdjointEigenSolver<Matrix3> eigen;
  eigen.computeDirect(covariance);
  const Vector3 rough = eigen.eigenvectors().col(0), spread = eigen.eigenvalues();
  if (!(spread[1] > line_thinness * spread[2])) return {rough, 0, 0, 0};

  const Matrix3 shifted = covariance - rough.dot(covariance * rough) * Matrix3::Identity();
  Matrix3 adjugate;
  adjugate << shifted.col(1).cross(shifted.col(2)), shifted.col(2).cross(shifted.col(0)),
      shifted.col(0).cross(shifted.col(1));
  const Vector3 direction = (adjugate * rough).normalized();
  // A root at zero would make rounding a hundred million times as large as it is.
  constexpr double rounded_off = 1e-8;
  const double least = std::max(0.0, direction.dot(covariance * direction)) / spread[1];
  const double thickness = std::sqrt(least + rounded_off) - std::sqrt(rounded_off);
  return {direction, std::max(0.0, 1 - thickness), std::sqrt(least * spread[1]),
          std::sqrt(spread[1])};
}

}  // namespace

double Surfel::flatness_without(double noise) const {
  const double thin = thickness * thickness - noise * noise, wide = width * width - noise * noise;
  return wide > 0 ? std::max(flatness, 1 - std::sqrt(std::max(0.0, thin) / wide)) : flatness;
}

Vector3 Surfel::smoothed(const Vector3& x, double width) const {
  const double narrow = width * width * width * width;
  Matrix3 widened = covariance * covariance;
  widened.diagonal().array() += narrow;
  return x - narrow * (widened.inverse() * (x - mean));
}

// What is known of the points of a cell.
struct Surfels::Patch {
  Cell cell;
  Moments moments;
  Neighbour nearest;  // to the middle of the cell
  Vector3 sampled = Vector3::Zero();

  void sample(const Neighbour& candidate, const Vector3& x) {
    if (!(candidate < nearest)) return;
    nearest = candidate;
    sampled = x;
  }
};

Surfels::Surfels(const Cloud& cloud, Index count, const Context& context)
    : Surfels(cloud, count, 0, context) {}

Surfels::Surfels(const Cloud& cloud, const Surfels& coarser, const Context& context)
    : Surfels(cloud, 4 * coarser.count_, coarser.spacing() / 2, context) {}

Surfels::Surfels(const Cloud& cloud, Index count, double guess, const Context& context)
    : count_(count), low_(cloud.frame.low) {
  choose_cell(cloud, guess, context.stage(0, 0.5));
  sum_moments(cloud, context.stage(0.5, 1));
}

Points Surfels::positions(Index count) const {
  const Index stride = std::max<Index>(1, size() / count);
  Points positions((size() + stride - 1) / stride, 3);
  for (Index i = 0; i < positions.rows(); ++i)
    positions.row(i) = surfels_[i * stride].position.transpose();
  return positions;
}

// Sheets fill cells as the square of the resolution, so two or three guesses are enough. The first
// is that edge of a cell, where it is given.
void Surfels::choose_cell(const Cloud& cloud, double guess, const Context& context) {
  const double longest = (cloud.frame.high - cloud.frame.low).maxCoeff();
  // More than one point a cell: alone it tells of no patch.
  const double wanted =
      std::min(static_cast<double>(count_), 0.7 * static_cast<double>(cloud.total));
  double cells =
      std::min<double>(finest_cells, guess > 0 ? longest / guess : 1 + std::sqrt(wanted));
  constexpr int guesses = 4;
  for (int k = 0; k < guesses; ++k) {
    cell_ = longest / cells;
    cells_ = 1 / cell_;
    // Off any lattice that the points may lie on: rounding must not decide between two cells.
    low_ = cloud.frame.low.array() - lattice_shift * cell_;
    size_ = ((cloud.frame.high - low_) * cells_).array().floor().cast<int>() + 1;
    std::vector<std::uint8_t> seen(size_.cast<Index>().prod(), 0);
    for (Index i = 0; i < cloud.points.size(); ++i)
      seen[linear(cell_of(cloud.frame.enter(cloud.points[i])))] = 1;
    if (context.communicator())
      for (const std::vector<std::uint8_t>& part : gathered(context, seen))
        for (std::size_t c = 0; c < seen.size(); ++c) seen[c] |= part[c];
    const double occupied = static_cast<double>(std::count(seen.begin(), seen.end(), 1));
    context.report((k + 1.0) / guesses);
    const double better = std::min<double>(finest_cells, cells * std::sqrt(wanted / occupied));
    if (std::abs(occupied / wanted - 1) < 0.15 || std::abs(better - cells) < 0.5) return;
    cells = better;
  }
}

void Surfels::sum_moments(const Cloud& cloud, const Context& context) {
  slot_.assign(size_.cast<Index>().prod(), -1);
  std::vector<Patch> patches;
  for (Index i = 0; i < cloud.points.size(); ++i) {
    const Vector3 x = cloud.frame.enter(cloud.points[i]);
    const Cell c = cell_of(x);
    std::int32_t& s = slot_[linear(c)];
    if (s < 0) {
      s = static_cast<std::int32_t>(patches.size());
      patches.emplace_back().cell = c;
    }
    const Vector3 middle = low_ + cell_ * (c.cast<double>().array() + 0.5).matrix();
    patches[s].moments.add(x - low_);
    patches[s].sample({cloud.first + i, (x - middle).squaredNorm()}, x);
    if (i % grain == 0)
      context.report(static_cast<double>(i) / static_cast<double>(cloud.points.size()));
  }

  if (context.communicator()) join(patches, context);

  // In the order of the cells, not in that of the points.
  std::sort(patches.begin(), patches.end(),
            [&](const Patch& a, const Patch& b) { return linear(a.cell) < linear(b.cell); });
  for (std::size_t s = 0; s < patches.size(); ++s)
    slot_[linear(patches[s].cell)] = static_cast<std::int32_t>(s);
  surfels_.reserve(patches.size());
  for (const Patch& patch : patches) {
    Moments around;
    const Cell from = (patch.cell.array() - 1).max(0);
    const Cell to = (patch.cell.array() + 1).min(size_.array() - 1);
    for (int x = from.x(); x <= to.x(); ++x)
      for (int y = from.y(); y <= to.y(); ++y) {
        const std::int32_t* row = &slot_[linear({x, y, 0})];
        for (int z = from.z(); z <= to.z(); ++z)
          if (row[z] >= 0) around += patches[row[z]].moments;
      }
    const Matrix3 covariance = around.covariance();
    const Thinnest thinnest = thinnest_direction(covariance);
    surfels_.push_back({{thinnest.direction, thinnest.flatness},
                        low_ + patch.moments.mean(),
                        thinnest.thickness,
                        thinnest.width,
                        patch.sampled,
                        low_ + around.mean(),
                        covariance});
  }
}

// The patches of all processes, those of one cell made one.
void Surfels::join(std::vector<Patch>& patches, const Context& context) {
  const auto parts = gathered(context, patches);
  patches.clear();
  std::fill(slot_.begin(), slot_.end(), -1);
  for (const std::vector<Patch>& part : parts)
    for (const Patch& patch : part) {
      std::int32_t& s = slot_[linear(patch.cell)];
      if (s < 0) {
        s = static_cast<std::int32_t>(patches.size());
        patches.push_back(patch);
        continue;
      }
      patches[s].moments += patch.moments;
      patches[s].sample(patch.nearest, patch.sampled);
    }
}

Index Surfels::containing(const Vector3& x) const {
  const Vector3 at = (x - low_) * cells_;
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
