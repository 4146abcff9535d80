#include "cloud/cloud.h"

#include <symsurf/context.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <iterator>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/math.h"
#include "base/parallel.h"
#include "cloud/point_tree.h"
#include "cloud/surface_points.h"
#include "cloud/surfels.h"
#include "cloud/voxel_grid.h"

namespace symsurf {

namespace {

struct Thinned {
  Points points, normals;
  Cloud cloud;

  Thinned(const Cloud& whole, Index about, const Context& context) {
    const std::vector<Index> rows =
        drawn_with_images(whole.frame.to_frame(whole.points, context), about);
    points = chosen_rows(whole.points, rows);
    normals = chosen_rows(whole.normals, rows);
    cloud = checked_cloud(points, normals, 1, context);
    cloud.seed = whole.seed;
    cloud.tolerance = whole.tolerance;
  }
};

}  // namespace

struct Cloud::Parts {
  std::mutex tree_mutex, mutex;  // of the tree, and of all others
  std::optional<PointTree> tree;
  std::map<Index, Surfels> patches, finer_patches;  // by how many were asked for
  std::map<Index, Thinned> thinned;
};

Cloud::Cloud() : Cloud(PointsView()) {}

Cloud::Cloud(PointsView all, PointsView lines) { set_points(all, lines); }

void Cloud::set_points(PointsView all, PointsView lines) {
  points = all;
  normals = lines;
  parts_ = std::make_shared<Parts>();
}

const PointTree& Cloud::tree(const Context& context) const {
  const std::lock_guard lock(parts_->tree_mutex);
  if (!parts_->tree) parts_->tree.emplace(points, context);
  return *parts_->tree;
}

void Cloud::release_tree() const {
  constexpr Index large = 200'000;  // points: their tree takes 10 MB
  const std::lock_guard lock(parts_->tree_mutex);
  if (points.size() > large) parts_->tree.reset();
}

const Surfels& Cloud::patches(Index about, const Context& context) const {
  const std::lock_guard lock(parts_->mutex);
  return parts_->patches.try_emplace(about, *this, about, context).first->second;
}

const Surfels& Cloud::finer_patches(Index about, const Context& context) const {
  const Surfels& coarser = patches(about, context.stage(0, 0.5));
  const std::lock_guard lock(parts_->mutex);
  return parts_->finer_patches.try_emplace(about, *this, coarser, context.stage(0.5, 1))
      .first->second;
}

const Cloud& Cloud::thinned(Index about, const Context& context) const {
  if (points.size() <= about) return *this;
  const std::lock_guard lock(parts_->mutex);
  return parts_->thinned.try_emplace(about, *this, about, context).first->second.cloud;
}

namespace {

// A cloud thinner than this, against its length, is a line.
constexpr double line_thinness = 1e-8;

// Fourth powers of lengths are computed with, and must be numbers.
constexpr double least_extent = 1e-50, greatest_extent = 1e50;

// In one process: they, and twice as many, are counted in 32 bits.
constexpr Index most_points = Index{1} << 30;

// `extremes`: the lowest and the highest point along each axis.
void require_area(PointsView points, const std::vector<Vector3>& extremes, const Vector3& size) {
  const std::string all = "all " + std::to_string(points.size()) + " points ";
  Index longest;
  const double extent = size.maxCoeff(&longest);
  if (!(extent > 0)) throw InvalidInput(all + "are equal");
  if (extent < least_extent || extent > greatest_extent)
    throw InvalidInput("the points extend over " + to_string(Value(extent)) + "; allowed is " +
                       to_string(Value(least_extent)) + " to " + to_string(Value(greatest_extent)));
  const Vector3 start = extremes[2 * longest];
  const Vector3 direction = ((extremes[2 * longest + 1] - start) / extent).normalized();
  const auto is_beside_line = [&](Index i) {
    const Vector3 x = (points[i] - start) / extent;
    return (x - direction.dot(x) * direction).norm() > line_thinness;
  };
  // Mostly one of the first points ends the search.
  Index i = 0;
  while (i < points.size() && !is_beside_line(i)) ++i;
  if (i == points.size()) throw InvalidInput(all + "lie on one line");
}

}  // namespace

void require_count(Index given, Index needed) {
  if (given < needed)
    throw InvalidInput(std::to_string(given) + " points given; at least " + std::to_string(needed) +
                       (needed == 1 ? " is needed" : " are needed"));
}

bool is_numerable(Index own) { return own <= most_points; }

void require_numerable(Index own) {
  if (!is_numerable(own))
    throw InvalidInput(std::to_string(own) + " points given; at most " +
                       std::to_string(most_points) + " in one process are allowed");
}

bool are_finite(PointsView rows) {
  double sum = 0;  // NaN from the first that is not, without branches
  for (Index i = 0; i < 3 * rows.size(); ++i) sum += 0 * rows.data()[i];
  return sum == 0;
}

void require_finite(PointsView rows, const char* what, Index first) {
  if (are_finite(rows)) return;
  for (Index i = 0; i < rows.size(); ++i)
    if (!rows[i].allFinite())
      throw InvalidInput(std::string(what) + " " + std::to_string(first + i) + " is " +
                         to_string(Value(rows[i])) + "; coordinates must be finite");
}

void require_points(PointsView points) {
  require_count(points.size(), 1);
  require_finite(points, "point");
}

void require_coordinates(PointsView points, Index first) {
  for (Index i = 0; i < points.size(); ++i)
    if (points[i].allFinite() && points[i].cwiseAbs().maxCoeff() > greatest_extent)
      throw InvalidInput("point " + std::to_string(first + i) + " is " +
                         to_string(Value(points[i])) + "; allowed are coordinates up to " +
                         to_string(Value(greatest_extent)));
}

void require_extent(PointsView rows, const char* what) {
  Eigen::AlignedBox3d box;
  for (Index i = 0; i < rows.size(); ++i)
    if (rows[i].allFinite()) box.extend(rows[i]);
  const double extent = box.isEmpty() ? 0 : box.sizes().maxCoeff();
  if (extent > greatest_extent)
    throw InvalidInput("the " + std::string(what) + " extend over " + to_string(Value(extent)) +
                       "; allowed is up to " + to_string(Value(greatest_extent)));
}

void require_normals(PointsView points, PointsView normals, Index first) {
  if (normals.empty()) return;
  if (normals.size() != points.size())
    throw InvalidInput(std::to_string(normals.size()) + " normals given for " +
                       std::to_string(points.size()) + " points; one per point is needed");
  for (Index i = 0; i < normals.size(); ++i) {
    if (normals[i].allFinite() && !normals[i].isZero(0)) continue;
    if (!points[i].allFinite()) continue;
    throw InvalidInput("normal " + std::to_string(first + i) + " is " +
                       to_string(Value(normals[i])) + "; a finite direction is needed");
  }
}

void validate(Cloud& cloud, Index minimum_points, const Context& context) {
  const PointsView points = cloud.points;
  require_count(points.size(), minimum_points);
  require_numerable(points.size());
  require_finite(points, "point");
  const std::vector<Vector3> extremes = extreme_points(points);
  const Vector3 low(extremes[0].x(), extremes[2].y(), extremes[4].z());
  const Vector3 high(extremes[1].x(), extremes[3].y(), extremes[5].z());
  require_area(points, extremes, high - low);
  require_coordinates(points);
  require_normals(points, cloud.normals);
  cloud.diagonal = (high - low).norm();
  cloud.frame = principal_frame(points, context);
}

Cloud checked_cloud(PointsView points, PointsView normals, Index minimum_points,
                    const Context& context) {
  Cloud cloud(points, normals);
  validate(cloud, minimum_points, context);
  return cloud;
}

std::vector<Index> farthest_points(PointsView points, Index count, const Context& context) {
  const auto squared_distances = [&](const Vector3& from) {
    Eigen::VectorXd squares(points.size());
    for (Index i = 0; i < points.size(); ++i) squares[i] = (points[i] - from).squaredNorm();
    return squares;
  };
  Eigen::VectorXd distances = squared_distances(points.matrix().colwise().mean().transpose());
  std::vector<Index> chosen;
  while (static_cast<Index>(chosen.size()) < std::min(count, points.size())) {
    context.check();
    Index farthest;
    distances.maxCoeff(&farthest);
    const Eigen::VectorXd from = squared_distances(points[farthest]);
    distances = chosen.empty() ? from : Eigen::VectorXd(distances.cwiseMin(from));
    chosen.push_back(farthest);
  }
  return chosen;
}

std::vector<Vector3> extreme_points(PointsView points) {
  std::vector<Vector3> extremes;
  for (int axis = 0; axis < 3 && !points.empty(); ++axis) {
    Index low, high;
    points.matrix().col(axis).minCoeff(&low);
    points.matrix().col(axis).maxCoeff(&high);
    extremes.insert(extremes.end(), {points[low], points[high]});
  }
  return extremes;
}

Points footprint_of(const Cloud& cloud) {
  const PointsView points = cloud.footprint.empty() ? cloud.points : cloud.footprint;
  constexpr Index enough = 2000;
  const Index stride = std::max<Index>(1, points.size() / enough);
  std::vector<Vector3> chosen;
  for (Index i = 0; i < points.size(); i += stride) chosen.push_back(points[i]);
  const std::vector<Vector3> extremes = extreme_points(points);
  chosen.insert(chosen.end(), extremes.begin(), extremes.end());
  return rows_of(chosen);
}

void set_footprint(Result& result, const Cloud& cloud) {
  if (result.mirror) set_footprint(result, footprint_of(cloud));
}

void set_footprint(Result& result, Points rows) {
  const auto footprint = std::make_shared<const Points>(std::move(rows));
  if (result.mirror) result.mirror->set_footprint(footprint);
  for (Result& candidate : result.candidates)
    if (candidate.mirror) candidate.mirror->set_footprint(footprint);
}

DistinctPoints distinct_points(PointsView points, const Context& context) {
  DistinctPoints distinct;
  distinct.number.resize(points.size());
  TripleIndex positions;
  interruptible_for(context, points.size(), [&](Index i) {
    const Index position = positions.add(ordered_bits(points[i]));
    if (position == static_cast<Index>(distinct.first.size()))
      distinct.first.push_back(static_cast<std::int32_t>(i));
    distinct.number[i] = static_cast<std::int32_t>(position);
  });
  return distinct;
}

// By the points with the least hashes, each with all of its copies (Bar-Yossef et al., "Counting
// distinct elements in a data stream", 2002).
bool has_many_duplicates(PointsView points, const Context& context) {
  constexpr std::size_t most = 1000;  // distinct points looked at
  constexpr double notable = 0.05;
  std::map<std::uint64_t, Index> copies;  // by hash
  std::uint64_t greatest = ~std::uint64_t{0};
  interruptible_for(context, points.size(), [&](Index i) {
    const std::uint64_t hash = hash_of(points[i]);
    if (hash > greatest) return;
    ++copies[hash];
    if (copies.size() <= most) return;
    copies.erase(std::prev(copies.end()));
    greatest = copies.rbegin()->first;
  });
  Index all = 0;
  for (const auto& [hash, count] : copies) all += count;
  return static_cast<double>(copies.size()) < (1 - notable) * static_cast<double>(all);
}

}  // namespace symsurf
