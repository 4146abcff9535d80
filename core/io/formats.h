#pragma once

#include <symsurf/io.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <numeric>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace symsurf {

/// The number whose bytes stand at `bytes` in the given order.
template <typename T>
T load(const char* bytes, std::endian order) {
  std::array<char, sizeof(T)> native;
  std::memcpy(native.data(), bytes, sizeof(T));
  if (order != std::endian::native) std::reverse(native.begin(), native.end());
  return std::bit_cast<T>(native);
}

// The formats, one source each. All take a file's content and throw InvalidInput with the reason,
// and the line where there are lines; read() adds the file's name and drops normals that some
// points lack.

/// Turk's Polygon File Format 1.0: ascii, binary_little_endian, binary_big_endian. Elements but
/// vertex, those with polygons and tristrips, and properties but x y z nx ny nz, red green blue and
/// vertex_indices (vertex_index), are skipped.
Shape read_ply(std::string_view content);

/// Wavefront OBJ: v, vn and f. Colours stand behind the coordinates. A vertex's normal is the one
/// that its faces' corners name (their mean where they differ); without any in the faces, the
/// normals are the vertices' in order if there are as many.
Shape read_obj(std::string_view content);

/// Geomview's OFF, COFF, NOFF, CNOFF, with or without texture coordinates (ST); ascii, the keyword
/// missing or glued to the first number as well.
Shape read_off(std::string_view content);

/// Stereolithography, ascii in any case or binary. Equal corners of the triangles are one point.
Shape read_stl(std::string_view content);

/// XYZ, CSV, TXT and FCSV: rows of numbers, as read() describes them.
Shape read_columns(std::string_view content);

/// Collects what a file holds, of which it may not say beforehand how much there is.
class ShapeBuilder {
 public:
  Index points() const { return static_cast<Index>(points_.size()) / 3; }
  Index normals() const { return static_cast<Index>(normals_.size()) / 3; }

  void add_point(const Vector3& x) { points_.insert(points_.end(), {x.x(), x.y(), x.z()}); }
  void add_colour(const std::optional<Vector3>& c) {
    if (c) colours_.insert(colours_.end(), {c->x(), c->y(), c->z()});
  }
  void add_normal(const Vector3& n) { normals_.insert(normals_.end(), {n.x(), n.y(), n.z()}); }

  /// As a fan of triangles around the first corner; none for fewer than three corners.
  void add_polygon(std::span<const Index> corners) {
    has_others_ = has_others_ || corners.size() > 3;
    for (std::size_t c = 2; c < corners.size(); ++c)
      faces_.insert(faces_.end(), {corners[0], corners[c - 1], corners[c]});
    if (!has_others_) return;
    if (polygons_.empty()) {  // the triangles so far
      polygons_.resize(faces_.size() / 3 - (corners.size() - 2));
      std::iota(polygons_.begin(), polygons_.end(), 0);
    }
    const Index number = polygons_.empty() ? 0 : polygons_.back() + 1;
    polygons_.resize(faces_.size() / 3, number);
  }

  Shape build() const {
    return {Eigen::Map<const Points>(points_.data(), points(), 3),
            Eigen::Map<const Triangles>(faces_.data(), static_cast<Index>(faces_.size()) / 3, 3),
            Eigen::Map<const Points>(normals_.data(), normals(), 3),
            Eigen::Map<const Points>(colours_.data(), static_cast<Index>(colours_.size()) / 3, 3),
            Eigen::Map<const Eigen::Matrix<Index, Eigen::Dynamic, 1>>(
                polygons_.data(), static_cast<Index>(polygons_.size()))};
  }

 private:
  std::vector<double> points_, normals_, colours_;
  std::vector<Index> faces_, polygons_;
  bool has_others_ = false;  // than triangles
};

/// The reason why a face is broken, for an error.
inline std::string no_vertex(Index named, Index vertices) {
  return "a face names vertex " + std::to_string(named) + "; there are " +
         std::to_string(vertices) + ", counted from 0";
}

}  // namespace symsurf
