#include "surfels.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "../gathered.h"
#include "../point_tree.h"
#include "../symmetric_matrix.h"

namespace symsurf {

namespace {

constexpr Index grain = 1 << 16;
constexpr double lattice_shift = 0.38197;
constexpr double line_thinness = 1e-8;  // of the squared width against the squared length
constexpr int finest_cells = 128;       // along the longest side

// How many points, their sum, and that of their products: side by side, to be added at once.
struct Moments {
  Eigen::Matrix<double, 10, 1> sums = Eigen::Matrix<double, 10, 1>::Zero();

  Moments& operator+=(const Moments& other) {
    sums += other.sums;
    return *this;
  }
  void add(const Vector3& x) {
    sums[0] += 1;
    sums.segment<3>(1) += x;
    sums.segment<3>(4) += x.x() * x;
    sums.segment<2>(7) += x.y() * x.tail<2>();
    sums[9] += x.z() * x.z();
  }
  double count() const { return sums[0]; }
  Vector3 mean() const { return sums.segment<3>(1) / count(); }
  Matrix3 covariance() const {
    Matrix3 s;
    s << sums[4], sums[5], sums[6], sums[5], sums[7], sums[8], sums[6], sums[8], sums[9];
    return s / count() - mean() * mean().transpose();
  }
};

struct Thinnest {
  Vector3 direction;
  double flatness, thickness, width;
};

Thinnest thinnest_direction(const Matrix3& covariance) {
  const LeastEigen spread = least_eigen_of(covariance);
  if (!(spread.next > line_thinness * spread.greatest)) return {spread.vector, 0, 0, 0};
  // A root at zero would make rounding a hundred million times as large as it is.
  constexpr double rounded_off = 1e-8;
  const double least = spread.value / spread.next;
  const double thickness = std::sqrt(least + rounded_off) - std::sqrt(rounded_off);
  return {spread.vector, std::max(0.0, 1 - thickness), std::sqrt(spread.value),
          std::sqrt(spread.next)};
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
  Cell cell = Cell::Zero();
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
    occupied_ = OccupiedCells(size_.cast<Index>().prod());
    for (Index i = 0; i < cloud.points.size(); ++i)
      occupied_.add(linear(cell_of(cloud.frame.enter(cloud.points[i]))));
    if (context.communicator())
      for (const OccupiedCells::Words& part : gathered(context, occupied_.words()))
        occupied_.add(part);
    occupied_.number_them();
    const double occupied = static_cast<double>(occupied_.count());
    context.report((k + 1.0) / guesses);
    const double better = std::min<double>(finest_cells, cells * std::sqrt(wanted / occupied));
    if (std::abs(occupied / wanted - 1) < 0.15 || std::abs(better - cells) < 0.5) return;
    cells = better;
  }
}

void Surfels::sum_moments(const Cloud& cloud, const Context& context) {
  std::vector<Patch> patches(occupied_.count());
  for (Index i = 0; i < cloud.points.size(); ++i) {
    const Vector3 x = cloud.frame.enter(cloud.points[i]);
    const Cell c = cell_of(x);
    const Vector3 middle = low_ + cell_ * (c.cast<double>().array() + 0.5).matrix();
    Patch& patch = patches[occupied_.number(linear(c))];
    patch.cell = c;
    patch.moments.add(x - low_);
    patch.sample({cloud.first + i, (x - middle).squaredNorm()}, x);
    if (i % grain == 0)
      context.report(static_cast<double>(i) / static_cast<double>(cloud.points.size()));
  }

  if (context.communicator()) join(patches, context);

  surfels_.reserve(patches.size());
  for (const Patch& patch : patches) {
    Moments around;
    const Cell from = (patch.cell.array() - 1).max(0);
    const Cell to = (patch.cell.array() + 1).min(size_.array() - 1);
    for (int x = from.x(); x <= to.x(); ++x)
      for (int y = from.y(); y <= to.y(); ++y) {
        const Index row = linear({x, y, 0}), end = occupied_.before(row + to.z() + 1);
        for (Index k = occupied_.before(row + from.z()); k < end; ++k) around += patches[k].moments;
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
  std::erase_if(patches, [](const Patch& patch) { return patch.moments.count() == 0; });
  const auto parts = gathered(context, patches);
  patches.assign(occupied_.count(), {});
  for (const std::vector<Patch>& part : parts)
    for (const Patch& other : part) {
      Patch& patch = patches[occupied_.number(linear(other.cell))];
      patch.cell = other.cell;
      patch.moments += other.moments;
      patch.sample(other.nearest, other.sampled);
    }
}

Index Surfels::containing(const Vector3& x) const {
  const Vector3 at = (x - low_) * cells_;
  // Points on the far faces belong to the last cell, as in cell_of.
  if (!((at.array() >= 0).all() && (at.array() <= size_.cast<double>().array()).all())) return -1;
  return occupied_.number(linear(cell_of(x)));
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
