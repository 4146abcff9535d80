#include <symsurf/context.h>
#include <symsurf/parameter.h>
#include <symsurf/point_summary.h>
#include <symsurf/points.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <map>
#include <memory>
#include <numeric>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "cloud/voxel_grid.h"

namespace symsurf {

namespace {

constexpr double greatest = 1e50;  // coordinate, as everywhere in the core
constexpr int lowest_level =
    -230;                       // 2^-230 is 1e-50 over the 2^62 cells that an index has room for
constexpr int index_bits = 62;  // of a cell along an axis
constexpr int magnitude_bits = 64;  // points of one magnitude are within that many powers of two
constexpr Index fewest_cells = 64;  // at each magnitude eight meet in the origin, at any level
constexpr std::int64_t signature = 0x3179'6d6d'7573'7373;  // "sssummy1", of this layout
constexpr std::size_t header_numbers = 4, row_numbers = 11;
constexpr Index most_cells = 1 << 28;  // of indices of 32 bits, with room for those of a new part

// A sum of coordinates in units of 2^-64 with 63 bits before the point: exact, whatever the order.
class FixedPoint {
 public:
  void add(double x) {
    const double magnitude = std::abs(x), whole = std::floor(magnitude);
    FixedPoint summand{static_cast<std::int64_t>(whole),
                       static_cast<std::uint64_t>((magnitude - whole) * 0x1p64)};
    if (x < 0) summand = summand.negated();
    add(summand);
  }

  void add(const FixedPoint& other) {
    fraction_ += other.fraction_;
    whole_ += other.whole_ + (fraction_ < other.fraction_ ? 1 : 0);
  }

  double over(Index count) const {
    if (whole_ < 0) return -negated().over(count);
    const std::int64_t quotient = whole_ / count, rest = whole_ % count;
    const double below = static_cast<double>(rest) + 0x1p-64 * static_cast<double>(fraction_);
    return static_cast<double>(quotient) + below / static_cast<double>(count);
  }

  FixedPoint() = default;
  FixedPoint(std::int64_t whole, std::uint64_t fraction) : whole_(whole), fraction_(fraction) {}

  std::int64_t whole() const { return whole_; }
  std::uint64_t fraction() const { return fraction_; }

 private:
  FixedPoint negated() const { return {-whole_ - (fraction_ > 0 ? 1 : 0), ~fraction_ + 1}; }

  std::int64_t whole_ = 0;
  std::uint64_t fraction_ = 0;
};

struct SummedCell {
  Index count = 0;
  std::array<FixedPoint, 3> sum;

  void add(const SummedCell& other) {
    count += other.count;
    for (int axis = 0; axis < 3; ++axis) sum[axis].add(other.sum[axis]);
  }
};

// The occupied cells of points of one magnitude.
struct SummedCells {
  TripleIndex places;
  std::vector<SummedCell> cells;

  SummedCell& at(const Triple& place) {
    const Index number = places.add(place);
    if (number == static_cast<Index>(cells.size())) cells.emplace_back();
    return cells[number];
  }
};

Triple coarser(Triple place, int levels) {
  for (std::int64_t& index : place) index >>= std::min(levels, 63);
  return place;
}

// The power of two above the largest coordinate; of zero the least there is.
int exponent_of(double largest) {
  int exponent = lowest_level + index_bits;
  if (largest > 0) std::frexp(largest, &exponent);
  return std::max(exponent, lowest_level + index_bits);
}

// Points of magnitude m have coordinates below 2^(32 + 64 m), to be divided by 2^(64 m).
int magnitude_of(double largest) {
  return static_cast<int>(
      std::ceil((exponent_of(largest) - magnitude_bits / 2) / static_cast<double>(magnitude_bits)));
}

Triple place_of(const Vector3& x, double per_unit) {
  const Eigen::Vector<std::int64_t, 3> place = (x * per_unit).array().floor().cast<std::int64_t>();
  return {place.x(), place.y(), place.z()};
}

// Of the finite ones.
Eigen::AlignedBox3d box_of(PointsView points) {
  Eigen::AlignedBox3d box;
  for (Index i = 0; i < points.size(); ++i)
    if (points[i].allFinite()) box.extend(points[i]);
  return box;
}

}  // namespace

struct PointSummary::Grid {
  Index limit, count = 0, nonfinite = 0;
  int level = lowest_level;  // the edge of a cell is 2^level
  std::map<int, SummedCells> by_magnitude;

  Index size() const {
    Index sum = 0;
    for (const auto& [magnitude, cells] : by_magnitude) sum += cells.places.size();
    return sum;
  }

  Index size_of_coarser(int levels) const {
    Index sum = 0;
    for (const auto& [magnitude, cells] : by_magnitude) {
      TripleIndex places;
      for (Index i = 0; i < cells.places.size(); ++i) places.add(coarser(cells.places[i], levels));
      sum += places.size();
    }
    return sum;
  }

  void coarsen(int levels) {
    if (levels <= 0) return;
    for (auto& [magnitude, cells] : by_magnitude) {
      SummedCells merged;
      for (Index i = 0; i < cells.places.size(); ++i)
        merged.at(coarser(cells.places[i], levels)).add(cells.cells[i]);
      cells = std::move(merged);
    }
    level += levels;
  }

  // By as many levels as it takes, of which the count of cells decides alone, not the order of
  // points.
  void keep_limit() {
    if (size() <= limit) return;
    int too_few = 0, enough = 1;
    while (size_of_coarser(enough) > limit) too_few = std::exchange(enough, 2 * enough);
    while (enough - too_few > 1) {
      const int middle = std::midpoint(too_few, enough);
      (size_of_coarser(middle) > limit ? too_few : enough) = middle;
    }
    coarsen(enough);
  }

  // So that an index of a cell does not overflow.
  void make_room(double largest) { coarsen(exponent_of(largest) - index_bits - level); }

  bool have_too_many(PointsView points, int level) const {
    const double per_unit = std::ldexp(1, -level);
    TripleIndex places;
    for (Index i = 0; i < points.size(); ++i)
      if (points[i].allFinite() && places.add(place_of(points[i], per_unit)) >= limit) return true;
    return false;
  }

  // To what these points alone need, from a guess on: the first 10^6 take 0.3 s in place of the 0.7
  // in which keep_limit() comes to it, step by step.
  void coarsen_for(PointsView points, double extent) {
    int fine_enough = std::max(exponent_of(extent / std::sqrt(static_cast<double>(limit))), level);
    while (have_too_many(points, fine_enough)) ++fine_enough;
    while (fine_enough > level && !have_too_many(points, fine_enough - 1)) --fine_enough;
    coarsen(fine_enough - level);
  }

  void add(const Vector3& x) {
    const int magnitude = magnitude_of(x.lpNorm<Eigen::Infinity>());
    const double unit = std::ldexp(1, -magnitude_bits * magnitude);
    SummedCell& cell = by_magnitude[magnitude].at(place_of(x, std::ldexp(1, -level)));
    ++cell.count;
    for (int axis = 0; axis < 3; ++axis) cell.sum[axis].add(x[axis] * unit);
    ++count;
    if (cell.count == 1) keep_limit();
  }

  // Of the same level.
  void add(const Grid& other) {
    for (const auto& [magnitude, cells] : other.by_magnitude)
      for (Index i = 0; i < cells.places.size(); ++i)
        by_magnitude[magnitude].at(cells.places[i]).add(cells.cells[i]);
    count += other.count;
    nonfinite += other.nonfinite;
    keep_limit();
  }

  void add(std::span<const std::int64_t, row_numbers> row) {
    SummedCell cell{row[4], {}};
    for (int axis = 0; axis < 3; ++axis)
      cell.sum[axis] = {row[5 + 2 * axis], std::bit_cast<std::uint64_t>(row[6 + 2 * axis])};
    by_magnitude[static_cast<int>(row[3])].at({row[0], row[1], row[2]}).add(cell);
    count += cell.count;
  }

  struct Row {
    Triple place;
    int magnitude;
    SummedCell cell;
    auto order() const { return std::pair(place, magnitude); }
  };

  std::vector<Row> rows() const {
    std::vector<Row> rows;
    for (const auto& [magnitude, cells] : by_magnitude)
      for (Index i = 0; i < cells.places.size(); ++i)
        rows.push_back({cells.places[i], magnitude, cells.cells[i]});
    std::sort(rows.begin(), rows.end(),
              [](const Row& a, const Row& b) { return a.order() < b.order(); });
    return rows;
  }
};

PointSummary::PointSummary(Index cells) {
  if (cells < fewest_cells || cells > most_cells)
    throw InvalidParameter("cells is " + std::to_string(cells) + "; allowed is [" +
                           std::to_string(fewest_cells) + ", " + std::to_string(most_cells) + "]");
  grid_ = std::make_unique<Grid>();
  grid_->limit = cells;
}

PointSummary::PointSummary(const PointSummary& other)
    : grid_(std::make_unique<Grid>(*other.grid_)) {}
PointSummary::PointSummary(PointSummary&&) noexcept = default;
PointSummary& PointSummary::operator=(PointSummary other) noexcept {
  grid_ = std::move(other.grid_);
  return *this;
}
PointSummary::~PointSummary() = default;

void PointSummary::add(PointsView points) {
  const Eigen::AlignedBox3d box = box_of(points);
  const double largest =
      box.isEmpty() ? 0 : box.min().cwiseAbs().cwiseMax(box.max().cwiseAbs()).maxCoeff();
  if (largest > greatest)
    throw InvalidInput("a coordinate is " + to_string(Value(largest)) +
                       " in size; allowed is up to 1e50");
  grid_->make_room(largest);
  if (points.size() > std::max(grid_->limit, grid_->count))
    grid_->coarsen_for(points, box.sizes().maxCoeff());
  for (Index i = 0; i < points.size(); ++i) {
    if (points[i].allFinite())
      grid_->add(points[i]);
    else
      ++grid_->nonfinite;
  }
}

void PointSummary::add(const PointSummary& other) {
  if (other.cells() != cells())
    throw InvalidParameter("a summary of at most " + std::to_string(other.cells()) +
                           " cells is added to one of " + std::to_string(cells()) +
                           "; they must be the same");
  Grid theirs = *other.grid_;
  theirs.coarsen(grid_->level - theirs.level);
  grid_->coarsen(theirs.level - grid_->level);
  grid_->add(theirs);
}

Index PointSummary::count() const { return grid_->count; }
Index PointSummary::nonfinite() const { return grid_->nonfinite; }
Index PointSummary::cells() const { return grid_->limit; }
Index PointSummary::size() const { return grid_->size(); }
double PointSummary::edge() const { return std::ldexp(1, grid_->level); }

Points PointSummary::means() const {
  const std::vector<Grid::Row> rows = grid_->rows();
  Points means(static_cast<Index>(rows.size()), 3);
  for (Index i = 0; i < means.rows(); ++i) {
    const auto& [place, magnitude, cell] = rows[i];
    for (int axis = 0; axis < 3; ++axis)
      means(i, axis) = std::ldexp(cell.sum[axis].over(cell.count), magnitude_bits * magnitude);
  }
  return means;
}

Eigen::VectorX<Index> PointSummary::counts() const {
  const std::vector<Grid::Row> rows = grid_->rows();
  Eigen::VectorX<Index> counts(static_cast<Index>(rows.size()));
  for (Index i = 0; i < counts.size(); ++i) counts[i] = rows[i].cell.count;
  return counts;
}

// A header and a row for each cell, all of 64-bit integers.
std::vector<std::byte> PointSummary::bytes() const {
  std::vector<std::int64_t> numbers{signature, grid_->limit, grid_->nonfinite, grid_->level};
  for (const auto& [place, magnitude, cell] : grid_->rows()) {
    numbers.insert(numbers.end(), place.begin(), place.end());
    numbers.insert(numbers.end(), {magnitude, cell.count});
    for (const FixedPoint& sum : cell.sum)
      numbers.insert(numbers.end(), {sum.whole(), std::bit_cast<std::int64_t>(sum.fraction())});
  }
  const auto raw = std::as_bytes(std::span(numbers));
  return {raw.begin(), raw.end()};
}

PointSummary PointSummary::from_bytes(std::span<const std::byte> bytes) {
  std::vector<std::int64_t> numbers(bytes.size() / sizeof(std::int64_t));
  std::memcpy(numbers.data(), bytes.data(), numbers.size() * sizeof(std::int64_t));
  if (bytes.size() % sizeof(std::int64_t) != 0 || numbers.size() < header_numbers ||
      (numbers.size() - header_numbers) % row_numbers != 0 || numbers[0] != signature)
    throw InvalidInput("the " + std::to_string(bytes.size()) + " bytes are no summary of points");
  PointSummary summary(numbers[1]);
  summary.grid_->nonfinite = numbers[2];
  summary.grid_->level = static_cast<int>(numbers[3]);
  for (std::size_t at = header_numbers; at < numbers.size(); at += row_numbers) {
    const auto row = std::span(numbers).subspan(at).first<row_numbers>();
    if (row[4] < 1)
      throw InvalidInput("a cell of the summary has " + std::to_string(row[4]) + " points");
    summary.grid_->add(row);
  }
  return summary;
}

}  // namespace symsurf
