#include "mirrors/mirror_layers.h"

#include <algorithm>
#include <cmath>

#include "spatial/point_tree.h"

namespace symsurf {

namespace {

constexpr double normal_consistency = 0.5;  // cosine: 60 degrees from the mirror's normal
constexpr double steepest = 2;              // that a surface that faces the mirror rises over it
constexpr double near = 0.02;               // of the size
// Shares of the cloud: surfaces that cross themselves at a crease, and bodies that close.
constexpr double creased = 0.03, closed = 0.055;
constexpr double layers_in_many_places = 0.025;

}  // namespace

void MirrorLayers::add(const Vector3& x, const Vector3& normal, const Vector3& image) {
  ++added_;
  const Vector3 chord = image - x;
  const double distance = chord.norm() / 2;
  if (std::abs(normal.dot(chord)) > normal_consistency * 2 * distance)
    facing_.push_back({(x + image) / 2, distance});
  else if (distance < near * size_)
    ++crossing_;
}

double MirrorLayers::single() const {
  if (facing_.empty()) return 0;
  Points feet(static_cast<Index>(facing_.size()), 3);
  for (Index i = 0; i < feet.rows(); ++i) feet.row(i) = facing_[i].foot.transpose();
  const PointTree tree(feet);
  const double least = steepest * apart_ + rough_;
  Index layered = 0;
  for (const Position& position : facing_) {
    bool other = false;
    tree.within(position.foot, apart_, [&](Index k, double) {
      other = other || std::abs(facing_[k].distance - position.distance) > least;
    });
    layered += other;
  }
  const auto total = static_cast<double>(added_);
  const double crossing = static_cast<double>(crossing_) / total;
  const double layers = static_cast<double>(layered) / total;
  return std::clamp((crossing - creased) / (closed - creased), 0.0, 1.0) *
         (1 - std::min(1.0, layers / layers_in_many_places));
}

}  // namespace symsurf
