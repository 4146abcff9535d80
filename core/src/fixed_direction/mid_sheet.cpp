#include "mid_sheet.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>

namespace symsurf {

namespace {

constexpr double least_gap = 1.5;  // spacings between two sheets
constexpr double steepest = 3;     // slope of a sheet that is still trusted
constexpr double window = 1.0;     // spacings, of heights that agree
constexpr double rough = 1.5;      // spacings

}  // namespace

MidSheet::MidSheet(const WorkingCloud& cloud, const Context& context, double reach)
    : cloud_(cloud),
      context_(context),
      reach_(reach * cloud.spacing),
      cell_(std::max(1.5, reach) * cloud.spacing),
      flat_(cloud.size(), 3),
      sheet_(cloud.size(), 3),
      sorted_(cloud.size()),
      cell_of_(cloud.size()) {}

double MidSheet::explained(const Vector3& direction, double scatter) {
  project(direction);
  sort_into_cells();
  collect_votes(scatter);
  count_votes();
  explained_.assign(cloud_.size(), 0);
  const double agree = window * cloud_.spacing;
  for (const Vote& vote : votes_) {
    if (!voted_[vote.cell] || std::abs(vote.height - height_[vote.cell]) > agree) continue;
    const double r = roughness(vote.cell) / (rough * cloud_.spacing);
    const float e = static_cast<float>(1 / (1 + r * r));
    explained_[vote.first] = std::max(explained_[vote.first], e);
    explained_[vote.second] = std::max(explained_[vote.second], e);
  }
  double sum = 0, weights = 0;
  for (Index i = 0; i < cloud_.size(); ++i) {
    sum += sheet_(i, 2) * explained_[i];
    weights += sheet_(i, 2);
  }
  return sum / weights * std::sqrt(weights / static_cast<double>(cloud_.size()));
}

double MidSheet::most_explained(const WorkingCloud& cloud, const Vector3& direction) {
  return std::sqrt((cloud.normals * direction).cwiseAbs().mean());
}

void MidSheet::project(const Vector3& direction) {
  across_ = orthogonal_to(direction);
  flat_.leftCols<2>() = cloud_.points * across_;
  flat_.col(2) = cloud_.points * direction;
  for (Index i = 0; i < cloud_.size(); ++i) {
    const Vector3 normal = cloud_.normal(i);
    const double along = normal.dot(direction);
    Eigen::Vector2d slope = -(across_.transpose() * normal) / (along == 0 ? 1e-9 : along);
    const double steep = slope.norm();
    if (steep > steepest) slope *= steepest / steep;
    sheet_.row(i) << slope.x(), slope.y(), std::abs(along);
  }
}

void MidSheet::sort_into_cells() {
  low_ = flat_.leftCols<2>().colwise().minCoeff().transpose();
  const Eigen::Vector2d high = flat_.leftCols<2>().colwise().maxCoeff().transpose();
  columns_ = static_cast<Index>((high.x() - low_.x()) / cell_) + 1;
  rows_ = static_cast<Index>((high.y() - low_.y()) / cell_) + 1;
  start_.assign(columns_ * rows_ + 1, 0);
  for (Index i = 0; i < cloud_.size(); ++i) {
    const Index c = static_cast<Index>((flat_(i, 0) - low_.x()) / cell_);
    const Index r = static_cast<Index>((flat_(i, 1) - low_.y()) / cell_);
    cell_of_[i] = static_cast<std::int32_t>(r * columns_ + c);
    ++start_[cell_of_[i] + 1];
  }
  std::partial_sum(start_.begin(), start_.end(), start_.begin());
  next_.assign(start_.begin(), start_.end() - 1);
  for (Index i = 0; i < cloud_.size(); ++i)
    sorted_[next_[cell_of_[i]]++] = static_cast<std::int32_t>(i);
}

void MidSheet::collect_votes(double scatter) {
  votes_.clear();
  const double gap = least_gap * cloud_.spacing;
  const double narrow = 1 / (2 * scatter * scatter);
  const auto meet = [&](Index i, Index j) {
    const double du = flat_(j, 0) - flat_(i, 0), dv = flat_(j, 1) - flat_(i, 1);
    const double aside = du * du + dv * dv;
    if (aside > reach_ * reach_) return;
    const double u = flat_(i, 0) + du / 2, v = flat_(i, 1) + dv / 2;
    const double from_i = flat_(i, 2) + (sheet_(i, 0) * du + sheet_(i, 1) * dv) / 2;
    const double from_j = flat_(j, 2) - (sheet_(j, 0) * du + sheet_(j, 1) * dv) / 2;
    if (std::abs(from_i - from_j) < gap) return;
    const Index c = static_cast<Index>((u - low_.x()) / cell_);
    const Index r = static_cast<Index>((v - low_.y()) / cell_);
    const double to_u = low_.x() + (static_cast<double>(c) + 0.5) * cell_ - u;
    const double to_v = low_.y() + (static_cast<double>(r) + 0.5) * cell_ - v;
    const double slope_u = (sheet_(i, 0) + sheet_(j, 0)) / 2;
    const double slope_v = (sheet_(i, 1) + sheet_(j, 1)) / 2;
    const double height = (from_i + from_j) / 2 + slope_u * to_u + slope_v * to_v;
    votes_.push_back({i, j, static_cast<std::int32_t>(r * columns_ + c), static_cast<float>(height),
                      static_cast<float>(sheet_(i, 2) * sheet_(j, 2) * std::exp(-aside * narrow))});
  };
  for (Index r = 0; r < rows_; ++r) {
    context_.check();
    for (Index c = 0; c < columns_; ++c) {
      const Index here = r * columns_ + c;
      for (std::int32_t p = start_[here]; p < start_[here + 1]; ++p) {
        for (std::int32_t q = p + 1; q < start_[here + 1]; ++q) meet(sorted_[p], sorted_[q]);
        for (const auto& [dc, dr] : {std::pair{1, 0}, {-1, 1}, {0, 1}, {1, 1}}) {
          if (c + dc < 0 || c + dc >= columns_ || r + dr >= rows_) continue;
          const Index there = (r + dr) * columns_ + c + dc;
          for (std::int32_t q = start_[there]; q < start_[there + 1]; ++q)
            meet(sorted_[p], sorted_[q]);
        }
      }
    }
  }
}

// The window of heights with most weight wins its cell.
void MidSheet::count_votes() {
  vote_start_.assign(columns_ * rows_ + 1, 0);
  for (const Vote& vote : votes_) ++vote_start_[vote.cell + 1];
  std::partial_sum(vote_start_.begin(), vote_start_.end(), vote_start_.begin());
  by_cell_.resize(votes_.size());
  next_.assign(vote_start_.begin(), vote_start_.end() - 1);
  for (const Vote& vote : votes_) by_cell_[next_[vote.cell]++] = {vote.height, vote.weight};

  height_.assign(columns_ * rows_, 0);
  voted_.assign(columns_ * rows_, 0);
  const float width = static_cast<float>(window * cloud_.spacing);
  for (Index cell = 0; cell < columns_ * rows_; ++cell) {
    context_.check();
    const auto begin = by_cell_.begin() + vote_start_[cell];
    const auto end = by_cell_.begin() + vote_start_[cell + 1];
    std::sort(begin, end);
    float best = 0, inside = 0, moment = 0;
    auto low = begin;
    for (auto high = begin; high != end; ++high) {
      inside += high->second;
      moment += high->second * high->first;
      for (; high->first - low->first > width; ++low) {
        inside -= low->second;
        moment -= low->second * low->first;
      }
      if (inside > best) {
        best = inside;
        height_[cell] = moment / inside;
        voted_[cell] = 1;
      }
    }
  }
}

std::vector<MidSheet::Chord> MidSheet::chords() const {
  const double agree = window * cloud_.spacing;
  std::vector<Chord> chords;
  for (const Vote& vote : votes_) {
    if (!voted_[vote.cell] || std::abs(vote.height - height_[vote.cell]) > agree) continue;
    const bool upwards = flat_(vote.second, 2) > flat_(vote.first, 2);
    const Index low = upwards ? vote.first : vote.second;
    const Index high = upwards ? vote.second : vote.first;
    const Vector3 chord = (flat_.row(high) - flat_.row(low)).transpose();
    chords.push_back({low, high, chord.head<2>(), chord.z(), sheet_(low, 2) * sheet_(high, 2)});
  }
  return chords;
}

// The least bend of the surface through a cell and two opposite neighbours.
double MidSheet::roughness(Index cell) const {
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

Points MidSheet::cells() const {
  std::vector<Vector3> found;
  for (Index cell = 0; cell < columns_ * rows_; ++cell)
    if (voted_[cell])
      found.emplace_back(low_.x() + (static_cast<double>(cell % columns_) + 0.5) * cell_,
                         low_.y() + (static_cast<double>(cell / columns_) + 0.5) * cell_,
                         height_[cell]);
  Points points(static_cast<Index>(found.size()), 3);
  for (std::size_t i = 0; i < found.size(); ++i)
    points.row(static_cast<Index>(i)) = found[i].transpose();
  return points;
}

}  // namespace symsurf
