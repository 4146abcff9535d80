#include "point_group/surface_distance.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "base/math.h"
#include "cloud/triangle_mesh.h"
#include "preprocess/surface_samples.h"

namespace symsurf {

namespace {

constexpr Index samples_of_fit = 300, samples_of_test = 2000, seeds_of_grid = 20'000;
constexpr Index most_points = 30'000;  // of a cloud that are looked at
constexpr Index most_of_set = 1000;    // points: more without faces are samples of a surface
constexpr Index grid_cells = 64;

// About so many, beginning with one of the first.
std::vector<Vector3> every(const std::vector<Vector3>& all, Index about, Index turn = 0) {
  const auto count = static_cast<Index>(all.size());
  const Index stride = 1 + (count - 1) / std::max<Index>(1, about);
  std::vector<Vector3> some;
  for (Index i = turn % stride; i < count; i += stride) some.push_back(all[i]);
  return some;
}

// Squared distances along a row of a grid from those at its grid_cells (Felzenszwalb and
// Huttenlocher 2012).
void transform_row(std::array<double, grid_cells + 1>& row) {
  std::array<Index, grid_cells + 1> parabola{};
  std::array<double, grid_cells + 2> from{};
  const auto square = [](Index i) { return static_cast<double>(i * i); };
  const auto meeting = [&](Index q, Index p) {
    return (row[q] + square(q) - row[p] - square(p)) / static_cast<double>(2 * (q - p));
  };
  Index k = 0;
  from[0] = -infinity;
  from[1] = infinity;
  for (Index q = 1; q <= grid_cells; ++q) {
    while (meeting(q, parabola[k]) <= from[k]) --k;
    from[k + 1] = meeting(q, parabola[k]);
    parabola[++k] = q;
    from[k + 1] = infinity;
  }
  const std::array<double, grid_cells + 1> before = row;
  k = 0;
  for (Index q = 0; q <= grid_cells; ++q) {
    while (from[k + 1] < static_cast<double>(q)) ++k;
    row[q] = square(q - parabola[k]) + before[parabola[k]];
  }
}

}  // namespace

std::vector<Vector3> even_directions(int count) {
  std::vector<Vector3> directions;
  for (int i = 0; i < count; ++i) {
    const double z = (i + 0.5) / count, angle = 2 * std::numbers::pi * std::numbers::phi * i;
    const double radius = std::sqrt(1 - z * z);
    directions.emplace_back(radius * std::cos(angle), radius * std::sin(angle), z);
  }
  return directions;
}

void ImageDeviation::merge(const ImageDeviation& other) {
  maximum = std::max(maximum, other.maximum);
  quantile = std::max(quantile, other.quantile);
  missing = std::max(missing, other.missing);
}

SurfaceDistance::SurfaceDistance(const Cloud& cloud, const Cloud& given, const Context& context)
    : frame_(cloud.frame) {
  const PointsView points = given.points;
  std::vector<bool> is_vertex(points.size(), given.faces.empty());
  for (Index f = 0; f < given.faces.size(); ++f)
    for (int c = 0; c < 3; ++c) is_vertex[given.faces[f][c]] = true;
  for (const Index i : given.tree(context).order())
    if (is_vertex[i] && points[i].allFinite()) vertices_.push_back(frame_.to_frame(points[i]));
  find_ends();
  double diameter = 0;
  for (const Vector3& end : ends_)
    for (const Vector3& other : ends_) diameter = std::max(diameter, (end - other).norm());
  frame_ = frame_.with_size(diameter * frame_.size);
  for (std::vector<Vector3>* all : {&vertices_, &ends_})
    for (Vector3& x : *all) x /= diameter;
  if (given.faces.empty())
    sample_cloud(cloud, context);
  else
    sample_mesh(given, context);
  make_grid();
}

void SurfaceDistance::find_ends() {
  constexpr int directions = 60;
  std::vector<Index> found;
  for (const Vector3& direction : even_directions(directions))
    for (const double side : {1.0, -1.0}) {
      Index best = 0;
      for (std::size_t i = 0; i < vertices_.size(); ++i)
        if (side * direction.dot(vertices_[i] - vertices_[best]) > 0) best = static_cast<Index>(i);
      found.push_back(best);
    }
  const auto farthest_from = [&](const Vector3& x) {
    Index best = 0;
    for (std::size_t i = 0; i < vertices_.size(); ++i)
      if ((vertices_[i] - x).squaredNorm() > (vertices_[best] - x).squaredNorm())
        best = static_cast<Index>(i);
    return best;
  };
  // Towards the largest distance of two points.
  constexpr int steps = 4;
  found.push_back(farthest_from(Vector3::Zero()));
  for (int step = 0; step < steps; ++step) found.push_back(farthest_from(vertices_[found.back()]));
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  for (const Index i : found) ends_.push_back(vertices_[i]);
}

void SurfaceDistance::sample_mesh(const Cloud& given, const Context& context) {
  const Points points = frame_.to_frame(given.points, context);
  const TriangleMesh mesh(points, given.faces, context);
  mesh_.emplace(points, given.faces, context);
  normals_ = mesh.face_normals();
  faces_.resize(given.faces.size(), 3);
  std::vector<double> areas;
  std::map<std::pair<Index, Index>, Index> face_at;
  std::vector<std::pair<double, double>> sagittas;  // with the area
  for (Index f = 0; f < faces_.rows(); ++f) {
    const Index* corners = given.faces[f];
    faces_.row(f) << corners[0], corners[1], corners[2];
    const Vector3 x = points.row(corners[0]);
    const double area = (points.row(corners[1]).transpose() - x)
                            .cross(points.row(corners[2]).transpose() - x)
                            .norm() /
                        2;
    areas.push_back(std::isfinite(area) ? area : 0);
  }
  // Of a crease that may be one of a smooth surface: an arc whose chords, as wide as the smaller
  // face, turn by its angle.
  std::vector<double> sagitta(areas.size(), 0);
  for (Index f = 0; f < faces_.rows(); ++f)
    for (int c = 0; c < 3; ++c) {
      constexpr double most_turned = std::numbers::pi / 9;
      const auto edge = std::minmax(faces_(f, c), faces_(f, (c + 1) % 3));
      const auto [other, is_new] = face_at.try_emplace(edge, f);
      if (is_new) continue;
      const Index g = other->second;
      const double length = (points.row(edge.first) - points.row(edge.second)).norm();
      const double angle = std::acos(std::clamp(normals_.row(f).dot(normals_.row(g)), -1.0, 1.0));
      if (!(angle < most_turned) || !(length > 0)) continue;
      const double own = std::min(areas[f], areas[g]) * 2 / length * angle / 8;
      for (const Index face : {f, g}) sagitta[face] += own;
    }
  double all = 0, below = 0;
  for (std::size_t f = 0; f < areas.size(); ++f) {
    sagittas.emplace_back(sagitta[f], areas[f]);
    all += areas[f];
  }
  std::sort(sagittas.begin(), sagittas.end());
  for (const auto& [own, area] : sagittas) {
    if (below < all / 2) sagitta_ = own;
    below += area;
  }
  is_rim_ = mesh.is_boundary();
  is_closed_ = std::none_of(is_rim_.begin(), is_rim_.end(), [](bool is) { return is; });
  const auto sampled = [&](Index count) {
    std::vector<Vector3> found;
    for (const auto& [face, down, along] : even_face_samples(areas, count)) {
      const Vector3 weights(1 - down, down * (1 - along), down * along);
      Vector3 x = Vector3::Zero();
      for (int c = 0; c < 3; ++c) x += weights[c] * points.row(faces_(face, c)).transpose();
      found.push_back(x);
    }
    return found;
  };
  samples_ = sampled(samples_of_fit);
  many_samples_ = sampled(seeds_of_grid);
}

void SurfaceDistance::sample_cloud(const Cloud& cloud, const Context& context) {
  if (cloud.points.size() <= most_of_set) {
    many_samples_ = vertices_;
    set_.emplace(rows_of(vertices_), context);
  } else {
    cloud_.emplace(frame_.to_frame(cloud.points, context), most_points, context);
    constexpr double one_sided = 0.45;  // 0.64: at a straight rim
    for (Index i = 0; i < cloud_->size(); ++i) {
      Vector3 mean = Vector3::Zero();
      double radius = 0;
      for (const Index j : cloud_->neighbours.row(i)) {
        const Vector3 off = cloud_->point(j) - cloud_->point(i);
        mean += off - off.dot(cloud_->normal(i)) * cloud_->normal(i);
        radius += off.norm();
      }
      is_rim_.push_back(mean.norm() > one_sided * radius);
      many_samples_.push_back(cloud_->point(i));
    }
  }
  samples_ = every(many_samples_, samples_of_fit);
}

SurfaceDistance::Foot SurfaceDistance::foot_on_mesh(const Vector3& x) const {
  constexpr double exact = 1e-7, least_past = 1e-4;  // diameters
  constexpr double along_normal = 0.7;               // cosine
  // The grid's points lie in its cells, and so does x: off by a diagonal at most.
  const double nearby = rough_foot(x).distance + 2 * std::sqrt(3.0) * reach_ / grid_cells;
  ClosestPoint closest = (*mesh_)(x, nearby * nearby);
  if (closest.face < 0) closest = (*mesh_)(x);  // beyond the grid
  const Vector3 off = x - closest.point, normal = normals_.row(closest.face);
  const double distance = off.norm();
  bool is_rim =
      !is_closed_ && distance > least_past && std::abs(off.dot(normal)) < along_normal * distance;
  for (int c = 0; is_rim && c < 3; ++c)
    is_rim = closest.weights[c] < double_rounding || is_rim_[faces_(closest.face, c)];
  return {distance, distance > exact ? Vector3(off / distance) : normal, is_rim};
}

SurfaceDistance::Foot SurfaceDistance::foot_on_cloud(const Vector3& x, Index nearest) const {
  if (set_) {
    const Vector3 off = x - vertices_[nearest];
    return {off.norm(), off.normalized(), false};
  }
  const Vector3 off = x - cloud_->point(nearest), normal = cloud_->normal(nearest);
  const double distance = off.norm(), height = off.dot(normal);
  const double along = std::sqrt(std::max(0.0, distance * distance - height * height));
  if (along < 2 * cloud_->spacing)
    return {std::abs(height), height < 0 ? Vector3(-normal) : normal, false};
  return {distance, off / distance, is_rim_[nearest] && std::abs(height) < along};
}

std::vector<SurfaceDistance::Foot> SurfaceDistance::feet(const std::vector<Vector3>& points) const {
  std::vector<Foot> found;
  if (mesh_) {
    for (const Vector3& x : points) found.push_back(foot_on_mesh(x));
    return found;
  }
  const std::vector<Neighbour> nearest = (set_ ? *set_ : cloud_->tree).nearest(points);
  for (std::size_t i = 0; i < points.size(); ++i)
    found.push_back(foot_on_cloud(points[i], nearest[i].index));
  return found;
}

void SurfaceDistance::make_grid() {
  constexpr double margin = 0.1;  // diameters
  for (const Vector3& end : ends_) reach_ = std::max(reach_, end.norm() + margin);
  constexpr Index row = grid_cells + 1;
  grid_.assign(row * row * row, static_cast<float>(3 * row * row));
  for (const std::vector<Vector3>* all : {&vertices_, &many_samples_})
    for (const Vector3& x : *all) {
      const Vector3 at = ((x.array() + reach_) / (2 * reach_) * grid_cells).round();
      cell(static_cast<Index>(at.x()), static_cast<Index>(at.y()), static_cast<Index>(at.z())) = 0;
    }
  std::array<double, row> values{};
  for (const Index stride : {row * row, row, Index{1}})
    for (Index begin = 0; begin < row * row * row; ++begin) {
      if (begin / stride % row != 0) continue;
      for (Index q = 0; q < row; ++q) values[q] = grid_[begin + q * stride];
      transform_row(values);
      for (Index q = 0; q < row; ++q) grid_[begin + q * stride] = static_cast<float>(values[q]);
    }
  const auto side = static_cast<float>(2 * reach_ / grid_cells);
  for (float& value : grid_) value = side * std::sqrt(value);
}

float& SurfaceDistance::cell(Index i, Index j, Index k) {
  return grid_[(i * (grid_cells + 1) + j) * (grid_cells + 1) + k];
}

SurfaceDistance::Foot SurfaceDistance::rough_foot(const Vector3& x) const {
  const double scale = grid_cells / (2 * reach_);
  constexpr double last = grid_cells - 1e-6;
  const Eigen::Array3d at = ((x.array() + reach_) * scale).max(0.0).min(last);
  const Eigen::Array3i low = at.cast<int>();
  const Eigen::Array3d t = at - low.cast<double>();
  const float* corner =
      &grid_[(static_cast<Index>(low.x()) * (grid_cells + 1) + low.y()) * (grid_cells + 1) +
             low.z()];
  Foot found;
  for (int k = 0; k < 8; ++k) {
    const Eigen::Array3d is(k & 4 ? 1 : -1, k & 2 ? 1 : -1, k & 1 ? 1 : -1);
    const Eigen::Array3d weight = (is > 0).select(t, 1 - t);
    const double value =
        corner[((k & 4 ? 1 : 0) * (grid_cells + 1) + (k & 2 ? 1 : 0)) * (grid_cells + 1) + (k & 1)];
    found.distance += value * weight.prod();
    found.gradient += value * scale *
                      (is * Eigen::Array3d(weight.y() * weight.z(), weight.z() * weight.x(),
                                           weight.x() * weight.y()))
                          .matrix();
  }
  return found;
}

ImageDeviation SurfaceDistance::deviation(const Eigen::Isometry3d& map, Index looked,
                                          Index turn) const {
  std::vector<Vector3> images = every(many_samples_, std::min(samples_of_test, looked / 2), turn);
  const std::size_t samples = images.size();
  for (const std::vector<Vector3>* others : {&vertices_, &ends_})
    for (const Vector3& x : every(*others, looked / 4, turn)) images.push_back(x);
  for (Vector3& x : images) x = map * x;
  ImageDeviation found;
  std::vector<double> distances;
  const std::vector<Foot> all = feet(images);
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (all[i].is_beyond_rim) {
      found.missing += i < samples ? 1 : 0;
      continue;
    }
    found.maximum = std::max(found.maximum, all[i].distance);
    if (i < samples) distances.push_back(all[i].distance);
  }
  found.missing /= static_cast<double>(samples);
  if (!distances.empty()) found.quantile = quantile(std::move(distances), quantile_share);
  return found;
}

Points SurfaceDistance::vertices() const {
  Points all = rows_of(vertices_);
  for (Index i = 0; i < all.rows(); ++i) all.row(i) = frame_.from_frame(all.row(i)).transpose();
  return all;
}

}  // namespace symsurf
