#pragma once

#include <symsurf/io.h>

#include <span>
#include <string>
#include <vector>

namespace symsurf {

/// Collects what a file holds, of which it may not say beforehand how much there is.
class ShapeBuilder {
 public:
  Index points() const { return static_cast<Index>(points_.size()) / 3; }
  Index normals() const { return static_cast<Index>(normals_.size()) / 3; }

  void add_point(const Vector3& x) { points_.insert(points_.end(), {x.x(), x.y(), x.z()}); }
  void add_normal(const Vector3& n) { normals_.insert(normals_.end(), {n.x(), n.y(), n.z()}); }

  /// As a fan of triangles around the first corner; none for fewer than three corners.
  void add_polygon(std::span<const Index> corners) {
    for (std::size_t c = 2; c < corners.size(); ++c)
      faces_.insert(faces_.end(), {corners[0], corners[c - 1], corners[c]});
  }

  Shape build() const {
    return {Eigen::Map<const Points>(points_.data(), points(), 3),
            Eigen::Map<const Triangles>(faces_.data(), static_cast<Index>(faces_.size()) / 3, 3),
            Eigen::Map<const Points>(normals_.data(), normals(), 3)};
  }

 private:
  std::vector<double> points_, normals_;
  std::vector<Index> faces_;
};

/// The reason why a face is broken, for an error.
inline std::string no_vertex(Index named, Index vertices) {
  return "a face names vertex " + std::to_string(named) + "; there are " +
         std::to_string(vertices) + ", counted from 0";
}

}  // namespace symsurf
