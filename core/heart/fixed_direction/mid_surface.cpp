#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numeric>
#include <vector>

#include "base/math.h"
#include "fixed_direction/fixed_direction.h"

namespace symsurf {

namespace {

constexpr double least_gap = 1.5;  // spacings between two surfaces
constexpr double steepest = 3;     // slope of a surface that is still trusted
constexpr double window = 1.0;     // spacings, of heights that agree
constexpr double rough = 1.5;      // spacings
constexpr double most_cells_a_point = 512;

// Floats as integers of the same order, side by side: sorting them compares but once.
std::uint64_t packed(float height, float weight) {
  const auto bits = std::bit_cast<std::uint32_t>(height);
  const std::uint32_t ordered = bits & 0x80000000u ? ~bits : bits | 0x80000000u;
  return static_cast<std::uint64_t>(ordered) << 32 | std::bit_cast<std::uint32_t>(weight);
}

float packed_height(std::uint64_t vote) {
  const auto ordered = static_cast<std::uint32_t>(vote >> 32);
  return std::bit_cast<float>(ordered & 0x80000000u ? ordered & 0x7fffffffu : ~ordered);
}

float packed_weight(std::uint64_t vote) {
  return std::bit_cast<float>(static_cast<std::uint32_t>(vote));
}

SYMSURF_VECTORISED void squared_offsets(const double* u, const double* v, Index count, double u0,
                                        double v0, double* squared) {
  for (Index k = 0; k < count; ++k) {
    const double du = u[k] - u0, dv = v[k] - v0;
    squared[k] = du * du + dv * dv;
  }
}

}  // namespace

MidSurface::MidSurface(const SurfacePoints& cloud, const Context& context, double reach)
    : cloud_(cloud),
      context_(context),
      reach_(reach * cloud.spacing),
      least_cell_(std::max(1.5, reach) * cloud.spacing),
      flat_(cloud.size(), 3),
      surface_(cloud.size(), 3),
      cell_of_(cloud.size()),
      u_(cloud.size()),
      v_(cloud.size()),
      positions_(cloud.size()),
      aside_(cloud.size()) {}

double MidSurface::support(const Vector3& direction, double scatter) {
  project(direction);
  sort_into_cells();
  collect_votes(scatter);
  count_votes();
  supported_.assign(cloud_.size(), 0);
  smooth_.assign(voted_.size(), 0);
  for (std::size_t cell = 0; cell < voted_.size(); ++cell) {
    if (!voted_[cell]) continue;
    const double r = roughness(static_cast<Index>(cell)) / (rough * cloud_.spacing);
    smooth_[cell] = static_cast<float>(1 / (1 + r * r));
  }
  const double agree = window * cloud_.spacing;
  for (const Vote& vote : votes_) {
    if (!voted_[vote.cell] || std::abs(vote.height - height_[vote.cell]) > agree) continue;
    const float e = smooth_[vote.cell];
    supported_[vote.first] = std::max(supported_[vote.first], e);
    supported_[vote.second] = std::max(supported_[vote.second], e);
  }
  double sum = 0, weights = 0;
  for (Index i = 0; i < cloud_.size(); ++i) {
    sum += surface_(i, 2) * supported_[i];
    weights += surface_(i, 2);
  }
  return sum / weights * std::sqrt(weights / static_cast<double>(cloud_.size()));
}

double MidSurface::support_bound(const SurfacePoints& cloud, const Vector3& direction) {
  return std::sqrt((cloud.normals * direction).cwiseAbs().mean());
}

void MidSurface::project(const Vector3& direction) {
  across_ = orthogonal_to(direction);
  flat_.leftCols<2>() = cloud_.points * across_;
  flat_.col(2) = cloud_.points * direction;
  for (Index i = 0; i < cloud_.size(); ++i) {
    const Vector3 normal = cloud_.normal(i);
    const double along = normal.dot(direction);
    Eigen::Vector2d slope = -(across_.transpose() * normal) / (along == 0 ? 1e-9 : along);
    const double steep = slope.norm();
    if (steep > steepest) slope *= steepest / steep;
    surface_.row(i) << slope.x(), slope.y(), std::abs(along);
  }
}

void MidSurface::sort_into_cells() {
  low_ = flat_.leftCols<2>().colwise().minCoeff().transpose();
  const Eigen::Vector2d high = flat_.leftCols<2>().colwise().maxCoeff().transpose();
  const Eigen::Vector2d extent = high - low_;
  // A point far from all others makes cells larger, not more.
  const double most_cells = most_cells_a_point * static_cast<double>(cloud_.size());
  cell_ = std::max(least_cell_, std::sqrt(extent.cwiseMax(least_cell_).prod() / most_cells));
  columns_ = static_cast<Index>(extent.x() / cell_) + 1;
  rows_ = static_cast<Index>(extent.y() / cell_) + 1;
  start_.assign(columns_ * rows_ + 1, 0);
  for (Index i = 0; i < cloud_.size(); ++i) {
    const Index c = static_cast<Index>((flat_(i, 0) - low_.x()) / cell_);
    const Index r = static_cast<Index>((flat_(i, 1) - low_.y()) / cell_);
    cell_of_[i] = static_cast<std::int32_t>(r * columns_ + c);
    ++start_[cell_of_[i] + 1];
  }
  std::partial_sum(start_.begin(), start_.end(), start_.begin());
  next_.assign(start_.begin(), start_.end() - 1);
  for (Index i = 0; i < cloud_.size(); ++i) {
    const std::int32_t at = next_[cell_of_[i]]++;
    u_[at] = flat_(i, 0);
    v_[at] = flat_(i, 1);
    positions_[at] = {flat_(i, 2), surface_(i, 0), surface_(i, 1), surface_(i, 2),
                      static_cast<std::int32_t>(i)};
  }
}

void MidSurface::collect_votes(double scatter) {
  votes_.clear();
  const double narrow = 1 / (2 * scatter * scatter);
  for (Index r = 0; r < rows_; ++r) {
    context_.check();
    for (Index c = 0; c < columns_; ++c) {
      // Cells side by side lie so in memory: one run here and to the right, one in the next row.
      const Index here = r * columns_ + c, right = c + 1 < columns_ ? 1 : 0, left = c > 0 ? 1 : 0;
      const bool last = r + 1 == rows_;
      const std::int32_t below = last ? 0 : start_[here + columns_ - left];
      const std::int32_t below_end = last ? 0 : start_[here + columns_ + right + 1];
      for (std::int32_t p = start_[here]; p < start_[here + 1]; ++p) {
        vote(p, p + 1, start_[here + right + 1], narrow);
        vote(p, below, below_end, narrow);
      }
    }
  }
}

// Of the p-th point with those of a run.
void MidSurface::vote(std::int32_t p, std::int32_t begin, std::int32_t end, double narrow) {
  const double u_here = u_[p], v_here = v_[p];
  squared_offsets(u_.data() + begin, v_.data() + begin, end - begin, u_here, v_here, aside_.data());
  const double far = reach_ * reach_, gap = least_gap * cloud_.spacing;
  const Position& i = positions_[p];
  for (std::int32_t q = begin; q < end; ++q) {
    const double aside = aside_[q - begin];
    if (aside > far) continue;
    const Position& j = positions_[q];
    const double du = u_[q] - u_here, dv = v_[q] - v_here;
    const double from_i = i.height + (i.slope_u * du + i.slope_v * dv) / 2;
    const double from_j = j.height - (j.slope_u * du + j.slope_v * dv) / 2;
    if (std::abs(from_i - from_j) < gap) continue;
    const double u = u_here + du / 2, v = v_here + dv / 2;
    const Index c = static_cast<Index>((u - low_.x()) / cell_);
    const Index r = static_cast<Index>((v - low_.y()) / cell_);
    const double to_u = low_.x() + (static_cast<double>(c) + 0.5) * cell_ - u;
    const double to_v = low_.y() + (static_cast<double>(r) + 0.5) * cell_ - v;
    const double slope_u = (i.slope_u + j.slope_u) / 2;
    const double slope_v = (i.slope_v + j.slope_v) / 2;
    const double height = (from_i + from_j) / 2 + slope_u * to_u + slope_v * to_v;
    const double closeness = narrow > 0 ? std::exp(-aside * narrow) : 1;
    votes_.push_back({i.point, j.point, static_cast<std::int32_t>(r * columns_ + c),
                      static_cast<float>(height),
                      static_cast<float>(i.square * j.square * closeness)});
  }
}

// The window of heights with most weight wins its cell.
void MidSurface::count_votes() {
  vote_start_.assign(columns_ * rows_ + 1, 0);
  for (const Vote& vote : votes_) ++vote_start_[vote.cell + 1];
  std::partial_sum(vote_start_.begin(), vote_start_.end(), vote_start_.begin());
  by_cell_.resize(votes_.size());
  next_.assign(vote_start_.begin(), vote_start_.end() - 1);
  for (const Vote& vote : votes_) by_cell_[next_[vote.cell]++] = packed(vote.height, vote.weight);

  height_.assign(columns_ * rows_, 0);
  voted_.assign(columns_ * rows_, 0);
  const float width = static_cast<float>(window * cloud_.spacing);
  for (Index cell = 0; cell < columns_ * rows_; ++cell) {
    if (cell % columns_ == 0) context_.check();
    const auto begin = by_cell_.begin() + vote_start_[cell];
    const auto end = by_cell_.begin() + vote_start_[cell + 1];
    std::sort(begin, end);
    float best = 0, inside = 0, moment = 0;
    auto low = begin;
    for (auto high = begin; high != end; ++high) {
      const float top = packed_height(*high), weight = packed_weight(*high);
      inside += weight;
      moment += weight * top;
      for (; top - packed_height(*low) > width; ++low) {
        inside -= packed_weight(*low);
        moment -= packed_weight(*low) * packed_height(*low);
      }
      if (inside > best) {
        best = inside;
        height_[cell] = moment / inside;
        voted_[cell] = 1;
      }
    }
  }
}

std::vector<MidSurface::Chord> MidSurface::chords() const {
  const double agree = window * cloud_.spacing;
  std::vector<Chord> chords;
  for (const Vote& vote : votes_) {
    if (!voted_[vote.cell] || std::abs(vote.height - height_[vote.cell]) > agree) continue;
    const bool upwards = flat_(vote.second, 2) > flat_(vote.first, 2);
    const Index low = upwards ? vote.first : vote.second;
    const Index high = upwards ? vote.second : vote.first;
    const Vector3 chord = (flat_.row(high) - flat_.row(low)).transpose();
    chords.push_back({low, high, chord.head<2>(), chord.z(), surface_(low, 2) * surface_(high, 2)});
  }
  return chords;
}

// The least bend of the surface through a cell and two opposite neighbours.
double MidSurface::roughness(Index cell) const {
  const Index r = cell / columns_, c = cell % columns_;
  double least = 4 * cloud_.spacing;
  for (const auto& [dc, dr] : {std::pair{1, 0}, {0, 1}, {1, 1}, {1, -1}}) {
    if (c < dc || c + dc >= columns_ || r < std::abs(dr) || r + std::abs(dr) >= rows_) continue;
    const Index step = dr * columns_ + dc;
    if (!voted_[cell - step] || !voted_[cell + step]) continue;
    least = std::min<double>(
        least, std::abs(height_[cell - step] + height_[cell + step] - 2 * height_[cell]) / 2);
  }
  return least;
}

Points MidSurface::cells() const {
  std::vector<Vector3> found;
  for (Index cell = 0; cell < columns_ * rows_; ++cell)
    if (voted_[cell])
      found.emplace_back(low_.x() + (static_cast<double>(cell % columns_) + 0.5) * cell_,
                         low_.y() + (static_cast<double>(cell / columns_) + 0.5) * cell_,
                         height_[cell]);
  return rows_of(found);
}

namespace {

constexpr std::array<double, 4> scatters{0.6, 0.4, 0.25, 0.12};  // spacings
constexpr int shifts = 4;                                        // at each
constexpr int sectors = 4;
constexpr double inner = 1.5, ring_inner = 1.8, ring_outer = 2.7;

struct Count {
  double inside = 0, inside_squares = 0;
  std::array<double, sectors> ring{};

  // Against the fullest direction of the ring: surfaces seen edge-on crowd along a line.
  double chance() const {
    constexpr double share =
        inner * inner / (ring_outer * ring_outer - ring_inner * ring_inner) * sectors;
    return *std::max_element(ring.begin(), ring.end()) * share;
  }
  double significance() const {
    return (inside - chance()) / std::sqrt(std::max(inside_squares, 1.0) + chance() * sectors / 4);
  }
};

SYMSURF_VECTORISED void shifted_squares(const double* u, const double* v, const double* length,
                                        std::size_t count, double at_u, double at_v, double scale,
                                        double* squares) {
  for (std::size_t k = 0; k < count; ++k) {
    const double du = u[k] - length[k] * at_u, dv = v[k] - length[k] * at_v;
    squares[k] = (du * du + dv * dv) * scale;
  }
}

// The chords' offsets side by side: most are passed over, at every shift.
class Offsets {
 public:
  explicit Offsets(const std::vector<MidSurface::Chord>& chords) : squares_(chords.size()) {
    for (const MidSurface::Chord& c : chords) {
      u_.push_back(c.offset.x());
      v_.push_back(c.offset.y());
      length_.push_back(c.length);
    }
  }

  // Of the offsets that are left when the direction moves to `at`.
  const double* squares(const Eigen::Vector2d& at, double scale) {
    shifted_squares(u_.data(), v_.data(), length_.data(), u_.size(), at.x(), at.y(), scale,
                    squares_.data());
    return squares_.data();
  }

 private:
  std::vector<double> u_, v_, length_, squares_;
};

}  // namespace

PartnerEvidence partner_evidence(const MidSurface& surface, const SurfacePoints& cloud,
                                 const Vector3& direction, const Context& context) {
  const std::vector<MidSurface::Chord> chords = surface.chords();
  PartnerEvidence best{direction, 0, 0};
  if (chords.size() < 10) return best;

  Offsets offsets(chords);
  Eigen::Vector2d at = Eigen::Vector2d::Zero();
  for (const double spacings : scatters) {
    const double scatter = spacings * cloud.spacing;
    const double narrow = 1 / (scatter * scatter);
    for (int shift = 0; shift <= shifts; ++shift) {
      context.check();
      Count count;
      double lever = 0, own = 0;
      Eigen::Vector2d pull = Eigen::Vector2d::Zero();
      const double* const squares = offsets.squares(at, narrow);
      for (std::size_t k = 0; k < chords.size(); ++k) {
        const double squared = squares[k];
        if (squared > ring_outer * ring_outer) continue;
        const MidSurface::Chord& c = chords[k];
        const Eigen::Vector2d o = c.offset - c.length * at;
        if (squared < inner * inner) {
          count.inside += c.weight;
          count.inside_squares += c.weight * c.weight;
        } else if (squared > ring_inner * ring_inner) {
          const bool steep = std::abs(o.y()) > std::abs(o.x());
          count.ring[(steep ? 2 : 0) + (o.x() * o.y() > 0 ? 1 : 0)] += c.weight;
        }
        const double kernel = 1 - squared / (ring_outer * ring_outer);
        const double weight = kernel * kernel * c.weight;
        pull += weight * c.length * o;
        lever += weight * c.length * c.length;
      }
      if (shift == shifts) {
        const double significance = count.significance();
        if (significance > best.significance)
          best = {(direction + surface.across() * at).normalized(), significance, scatter};
        break;
      }
      if (!(lever > 0)) break;
      own = std::clamp(1 - count.chance() / std::max(count.inside, 1e-9), 0.2, 1.0);
      Eigen::Vector2d step = pull / lever / own;
      const double longest = 2 * scatter;
      if (step.norm() > longest) step *= longest / step.norm();
      at += step;
    }
  }
  return best;
}

}  // namespace symsurf
