#include "point_group/surface_distance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>

#include "base/math.h"
#include "base/random.h"
#include "cloud/voxel_grid.h"
#include "preprocess/surface_samples.h"

namespace symsurf {

namespace {

constexpr double most_windows = 0.98;  // whose medians count: a sharp edge or corner makes others
constexpr Index dense_samples = 20'000, measured_samples = 2000;

template <typename T>
void shuffle(std::vector<T>& items) {
  Random random(5);
  for (std::size_t k = items.size(); k > 1; --k)
    std::swap(items[k - 1], items[random.below(static_cast<Index>(k))]);
}

std::vector<double> areas_of(const Points& points, const Triangles& faces) {
  std::vector<double> areas;
  for (const auto& face : faces.rowwise()) {
    const Vector3 x = points.row(face[0]), y = points.row(face[1]), z = points.row(face[2]);
    areas.push_back((y - x).cross(z - x).norm() / 2);
  }
  return areas;
}

Points samples_of(const Points& points, const Triangles& faces, Index count) {
  const std::vector<FaceSample> chosen = even_face_samples(areas_of(points, faces), count);
  Points samples(static_cast<Index>(chosen.size()), 3);
  for (Index k = 0; k < samples.rows(); ++k) {
    const auto& [f, down, along] = chosen[k];
    samples.row(k) = (1 - down) * points.row(faces(f, 0)) +
                     down * (1 - along) * points.row(faces(f, 1)) +
                     down * along * points.row(faces(f, 2));
  }
  return samples;
}

}  // namespace

SurfaceDistance::SurfaceDistance(const Cloud& shape, const PrincipalFrame& frame, bool is_set,
                                 const Context& context)
    : points_(finite_rows(frame.to_frame(shape.points, context))) {
  if (!shape.faces.empty()) {
    points_ = frame.to_frame(shape.points, context);
    faces_ = Eigen::Map<const Triangles>(shape.faces.data(), shape.faces.size(), 3);
    prepare_mesh(context);
  } else if (is_set) {
    prepare_set(shape.points, frame);
  } else {
    prepare_cloud(context);
  }
}

// Beside the distances, where rims are, and how far facets are off the surface that they stand for.
void SurfaceDistance::prepare_mesh(const Context& context) {
  constexpr double smooth = 0.21;          // radians: of a ball or cylinder of 30 facets and more
  constexpr double most_sagitta = 0.0025;  // diameters
  Index kept = 0;
  for (Index f = 0; f < faces_.rows(); ++f)
    if (points_(faces_.row(f).transpose(), Eigen::indexing::all).allFinite())
      faces_.row(kept++) = faces_.row(f).eval();
  faces_.conservativeResize(kept, 3);
  mesh_ = std::make_unique<const ClosestPointOnMesh>(points_, faces_, context);

  TripleIndex positions;
  std::map<std::array<Index, 2>, std::vector<std::array<Index, 2>>> edges;  // face and corner
  Eigen::Matrix<Index, Eigen::Dynamic, 3> welded(kept, 3);
  Points normals(kept, 3);
  for (Index f = 0; f < kept; ++f) {
    for (int c = 0; c < 3; ++c)
      welded(f, c) = positions.add(ordered_bits(points_.row(faces_(f, c)).transpose()));
    const Vector3 x = points_.row(faces_(f, 0)), y = points_.row(faces_(f, 1)),
                  z = points_.row(faces_(f, 2));
    normals.row(f) = (y - x).cross(z - x).normalized().transpose();
    for (int c = 0; c < 3; ++c) {
      const Index a = welded(f, (c + 1) % 3), b = welded(f, (c + 2) % 3);
      if (a != b) edges[{std::min(a, b), std::max(a, b)}].push_back({f, c});
    }
  }
  rims_.assign(kept, 0);
  std::vector<bool> at_rim(positions.size(), false);
  std::vector<double> sagittas(kept, 0);  // along all directions in which neighbours lean
  is_closed_ = true;
  for (const auto& [ends, sides] : edges) {
    if (sides.size() == 1) {
      is_closed_ = false;
      rims_[sides[0][0]] |= 1 << sides[0][1];
      at_rim[ends[0]] = at_rim[ends[1]] = true;
    }
    if (sides.size() != 2) continue;
    const double angle =
        std::acos(std::clamp(normals.row(sides[0][0]).dot(normals.row(sides[1][0])), -1.0, 1.0));
    if (!(angle < smooth)) continue;
    double width = 0;
    for (const auto& [f, c] : sides) {
      const Vector3 a = points_.row(faces_(f, (c + 1) % 3)),
                    b = points_.row(faces_(f, (c + 2) % 3)), x = points_.row(faces_(f, c));
      width += (b - a).normalized().cross(x - a).norm() / 2;
    }
    for (const auto& [f, c] : sides) sagittas[f] += width * angle / 8;
  }
  const double sagitta = kept > 0 ? *std::max_element(sagittas.begin(), sagittas.end()) : 0;
  for (Index f = 0; f < kept; ++f)
    for (int c = 0; c < 3; ++c)
      if (at_rim[welded(f, c)]) rims_[f] |= 8 << c;

  const Points dense = samples_of(points_, faces_, dense_samples);
  std::vector<Index> corners(faces_.data(), faces_.data() + faces_.size());
  std::sort(corners.begin(), corners.end());
  corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
  const Points vertices = points_(corners, Eigen::indexing::all);
  const Points even = samples_of(points_, faces_, measured_samples);
  for (const Vector3 x : even.rowwise()) samples_.push_back(x);
  shuffle(samples_);
  even_ = static_cast<Index>(samples_.size());
  const std::vector<Index> far = farthest_points(vertices, 60, context);
  for (const Index i : far)
    for (const Index j : far)
      diameter_ = std::max(diameter_, (vertices.row(i) - vertices.row(j)).norm());
  for (const Index i : far) samples_.push_back(vertices.row(i).transpose());
  std::vector<Vector3> rest;
  for (const Vector3 x : vertices.rowwise()) rest.push_back(x);
  shuffle(rest);
  rest.resize(std::min<std::size_t>(rest.size(), dense_samples));
  samples_.insert(samples_.end(), rest.begin(), rest.end());
  rounding_ = std::max(0.001 * diameter_, 2 * std::min(sagitta, most_sagitta * diameter_));
  Points all(dense.rows() + std::min<Index>(vertices.rows(), dense_samples), 3);
  all << dense, vertices.topRows(all.rows() - dense.rows());
  make_grid(all);
}

void SurfaceDistance::prepare_set(PointsView given, const PrincipalFrame& frame) {
  constexpr int most_decimals = 8;
  set_ = std::make_unique<const PointTree>(points_);
  for (const Vector3 x : points_.rowwise()) samples_.push_back(x);
  even_ = points_.rows();
  for (const Vector3& x : samples_)
    for (const Vector3& y : samples_) diameter_ = std::max(diameter_, (x - y).norm());
  rounding_ = 1e-5 * diameter_;
  double unit = 1;
  for (int decimals = 0; decimals <= most_decimals; ++decimals, unit /= 10) {
    const Eigen::ArrayXXd scaled = given.matrix().array() / unit;
    if (!((scaled - scaled.round()).abs() < 1e-6).all()) continue;
    // Half a unit for an image and for its partner, along three axes; the centre has some, too.
    rounding_ = std::max(rounding_, std::sqrt(3.0) * 1.2 * unit / frame.size);
    break;
  }
  make_grid(points_);
}

void SurfaceDistance::prepare_cloud(const Context& context) {
  const SurfacePoints noisy(points_, dense_samples, context);
  Points smooth = noisy.points;
  for (Index i = 0; i < noisy.size(); ++i) {
    Vector3 mean = noisy.point(i);
    for (const std::int32_t j : noisy.neighbours.row(i)) mean += noisy.point(j);
    mean /= SurfacePoints::ring + 1;
    smooth.row(i) -= ((noisy.point(i) - mean).dot(noisy.normal(i)) * noisy.normal(i)).transpose();
  }
  cloud_ = std::make_unique<const SurfacePoints>(std::move(smooth), context);
  even_ = cloud_->size();
  order_.resize(even_);
  std::iota(order_.begin(), order_.end(), Index{0});
  shuffle(order_);
  for (const Index i : order_) samples_.push_back(cloud_->point(i));
  const std::vector<Index> far = farthest_points(cloud_->points, 60, context);
  for (const Index i : far)
    for (const Index j : far)
      diameter_ = std::max(diameter_, (cloud_->point(i) - cloud_->point(j)).norm());
  rims_.assign(even_, 0);
  for (Index i = 0; i < even_; ++i) {
    constexpr double one_sided = 0.38;  // of the radius; the middle of a half disc is 0.42 away
    Vector3 sum = Vector3::Zero();
    double radius = 0;
    for (const std::int32_t j : cloud_->neighbours.row(i)) {
      const Vector3 gap = cloud_->point(j) - cloud_->point(i);
      sum += gap;
      radius = std::max(radius, gap.norm());
    }
    const Vector3 normal = cloud_->normal(i);
    rims_[i] = (sum - sum.dot(normal) * normal).norm() > one_sided * radius * SurfacePoints::ring;
  }
  rounding_ = std::max(0.001 * diameter_, std::hypot(0.55 * noisy.spacing, 2.5 * noisy.noise));
  make_grid(cloud_->points);
}

Offset SurfaceDistance::operator()(const Vector3& x) const {
  Offset offset;
  if (mesh_) {
    const ClosestPoint closest = (*mesh_)(x);
    const Vector3 a = points_.row(faces_(closest.face, 0)),
                  b = points_.row(faces_(closest.face, 1)),
                  c = points_.row(faces_(closest.face, 2));
    const Vector3 normal = (b - a).cross(c - a).normalized(), off = x - closest.point;
    offset.distance = std::sqrt(closest.squared_distance);
    // The difference of close points has no direction.
    offset.direction = offset.distance > 1e-7 ? Vector3(off / offset.distance) : normal;
    if (const std::uint8_t rims = rims_[closest.face]; rims != 0) {
      int zero = 0;
      for (int k = 0; k < 3; ++k) zero |= (closest.weights[k] == 0) << k;
      const int corner = zero == 6 ? 8 : zero == 5 ? 16 : zero == 3 ? 32 : 0;
      const bool on_rim = corner != 0 ? rims & corner : rims & zero;
      offset.missing = on_rim && std::abs(off.dot(normal)) < std::sqrt(0.5) * offset.distance;
    }
    return offset;
  }
  thread_local std::vector<Neighbour> near;
  if (set_) {
    const Neighbour found = set_->nearest(x);
    const Vector3 off = x - Vector3(points_.row(found.index));
    offset.distance = off.norm();
    if (offset.distance > 0) offset.direction = off / offset.distance;
    return offset;
  }
  constexpr double reach = 2;  // spacings: a disc of that radius without a point is a hole
  cloud_->tree.nearest(x, 3, near);
  offset.distance = infinity;
  for (const Neighbour& each : near) {
    const Vector3 off = x - cloud_->point(each.index), normal = cloud_->normal(each.index);
    const double height = off.dot(normal);
    const Vector3 along = off - height * normal;
    const double past = std::max(0.0, along.norm() - reach * cloud_->spacings[each.index]);
    const double distance = std::hypot(height, past);
    if (&each == &near.front())
      offset.missing = (past > 0 && std::abs(height) < along.norm()) ||
                       (rims_[each.index] != 0 && off.norm() > rounding_);
    if (distance >= offset.distance) continue;
    offset.distance = distance;
    offset.direction =
        past > 0 ? Vector3(off.normalized()) : Vector3(height < 0 ? -normal : normal);
  }
  return offset;
}

MapDeviation SurfaceDistance::deviation(const std::vector<Eigen::Isometry3d>& maps, Index images,
                                        double within) const {
  MapDeviation worst;
  const auto all = static_cast<Index>(samples_.size());
  const Index each =
      std::max<Index>(40, images / std::max<Index>(1, static_cast<Index>(maps.size())));
  double near = 0, missing = 0, count = 0;
  std::vector<double> distances, window, medians;
  Index first = 0;
  within = std::max({within, rounding_, 0.01 * diameter_});
  for (const Eigen::Isometry3d& map : maps) {
    if (map.isApprox(Eigen::Isometry3d::Identity(), 0)) continue;
    distances.clear();
    medians.clear();
    double greatest = 0;
    const auto look = [&](const Vector3& x) {
      const Offset offset = (*this)(map * x);
      ++count;
      if (offset.missing) {
        ++missing;
        return infinity;
      }
      near += offset.distance <= within;
      return offset.distance;
    };
    if (!cloud_) {
      const Index even = std::min(even_, std::max<Index>(each / 2, each - (all - even_)));
      const Index others = std::min(all - even_, each - even);
      for (Index k = 0; k < even; ++k)
        if (const double d = look(samples_[(first + k) % even_]); d < infinity)
          distances.push_back(d);
      for (Index k = 0; k < others; ++k)
        if (const double d = look(samples_[even_ + k]); d < infinity)
          greatest = std::max(greatest, d);
      if (!distances.empty())
        greatest = std::max(greatest, *std::max_element(distances.begin(), distances.end()));
    } else {
      // Whole neighbourhoods, as a single point says nothing.
      const Index windows = std::min(even_, each / (SurfacePoints::ring + 1) + 1);
      for (Index k = 0; k < windows; ++k) {
        const Index i = order_[(first + k) % even_];
        window.clear();
        if (const double d = look(cloud_->point(i)); d < infinity) window.push_back(d);
        for (const std::int32_t j : cloud_->neighbours.row(i))
          if (const double d = look(cloud_->point(j)); d < infinity) window.push_back(d);
        if (window.empty()) continue;
        distances.push_back(window.front());
        if (2 * window.size() > SurfacePoints::ring) medians.push_back(median(window));
      }
      first += windows;
      if (!medians.empty()) greatest = quantile(medians, most_windows);
    }
    worst.greatest = std::max(worst.greatest, greatest);
    if (!distances.empty()) worst.quantile = std::max(worst.quantile, quantile(distances, 0.95));
  }
  if (!is_closed_ && !set_ && maps.size() > 1) {
    constexpr double confirmed = 0.58;  // of an orbit: more than half, less than two of three
    const Index looked =
        std::min(even_, std::max<Index>(100, images / (4 * static_cast<Index>(maps.size()))));
    const std::size_t stride = 1 + maps.size() / 40;
    double alone = 0;
    for (Index k = 0; k < looked; ++k) {
      double on = 1, of = 1;
      for (std::size_t m = 0; m < maps.size(); m += stride, ++of) {
        const Offset offset = (*this)(maps[m] * samples_[k]);
        on += !offset.missing && offset.distance <= within;
      }
      alone += on < confirmed * of;
    }
    worst.alone = alone / static_cast<double>(looked);
  }
  if (count > missing) worst.near = near / (count - missing);
  if (count > 0) worst.missing = missing / count;
  return worst;
}

namespace {

// Squared distances along a line of a grid, from those of points on it (Felzenszwalb and
// Huttenlocher 2012).
void transform(float* values, Index count, Index stride, std::vector<float>& line,
               std::vector<Index>& at, std::vector<float>& from) {
  line.resize(count);
  at.resize(count);
  from.resize(count + 1);
  for (Index i = 0; i < count; ++i) line[i] = values[i * stride];
  Index k = -1;
  const auto square = [](Index i) { return static_cast<float>(i * i); };
  for (Index q = 0; q < count; ++q) {
    if (!(line[q] < 1e9f)) continue;
    float s = -1e9f;
    while (k >= 0) {
      s = (line[q] + square(q) - line[at[k]] - square(at[k])) / static_cast<float>(2 * (q - at[k]));
      if (s > from[k]) break;
      --k;
    }
    at[++k] = q;
    from[k] = k == 0 ? -1e9f : s;
  }
  if (k < 0) return;
  const Index last = k;
  k = 0;
  for (Index q = 0; q < count; ++q) {
    while (k < last && from[k + 1] < static_cast<float>(q)) ++k;
    values[q * stride] = square(q - at[k]) + line[at[k]];
  }
}

}  // namespace

void SurfaceDistance::make_grid(const Points& dense) {
  constexpr double resolution = 90, margin = 0.12;  // cells a diameter; of the diameter around
  cell_ = diameter_ / resolution;
  low_ = dense.colwise().minCoeff().transpose().array() - margin * diameter_;
  const Vector3 high = dense.colwise().maxCoeff().transpose().array() + margin * diameter_;
  cells_ = ((high - low_) / cell_).array().ceil().cast<Index>() + 1;
  const Index row = cells_[2], layer = cells_[1] * row;
  grid_.assign(cells_[0] * layer, 1e10f);
  for (const Vector3 x : dense.rowwise()) {
    const Eigen::Array<Index, 3, 1> at = ((x - low_) / cell_).array().round().cast<Index>();
    grid_[at[0] * layer + at[1] * row + at[2]] = 0;
  }
  std::vector<float> line, from;
  std::vector<Index> at;
  for (Index i = 0; i < cells_[0]; ++i)
    for (Index j = 0; j < cells_[1]; ++j)
      transform(&grid_[i * layer + j * row], cells_[2], 1, line, at, from);
  for (Index i = 0; i < cells_[0]; ++i)
    for (Index k = 0; k < cells_[2]; ++k)
      transform(&grid_[i * layer + k], cells_[1], row, line, at, from);
  for (Index j = 0; j < layer; ++j) transform(&grid_[j], cells_[0], layer, line, at, from);
  for (float& value : grid_) value = std::sqrt(value) * static_cast<float>(cell_);
}

Offset SurfaceDistance::rough(const Vector3& x) const {
  const Eigen::Array3d place =
      ((x - low_) / cell_).array().max(0).min((cells_ - 1).cast<double>() - 1e-6);
  const Eigen::Array<Index, 3, 1> at = place.cast<Index>();
  const Eigen::Array3d t = place - at.cast<double>(), s = 1 - t;
  const Index row = cells_[2], layer = cells_[1] * row;
  const float* g = &grid_[at[0] * layer + at[1] * row + at[2]];
  const double a = s[2] * g[0] + t[2] * g[1], b = s[2] * g[row] + t[2] * g[row + 1],
               c = s[2] * g[layer] + t[2] * g[layer + 1],
               d = s[2] * g[layer + row] + t[2] * g[layer + row + 1];
  const double e = s[1] * a + t[1] * b, f = s[1] * c + t[1] * d;
  Offset offset;
  offset.distance = s[0] * e + t[0] * f;
  offset.direction[0] = f - e;
  offset.direction[1] = s[0] * (b - a) + t[0] * (d - c);
  offset.direction[2] =
      s[0] * (s[1] * (g[1] - g[0]) + t[1] * (g[row + 1] - g[row])) +
      t[0] * (s[1] * (g[layer + 1] - g[layer]) + t[1] * (g[layer + row + 1] - g[layer + row]));
  offset.direction /= cell_;
  return offset;
}

}  // namespace symsurf
