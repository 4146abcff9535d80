#pragma once

#include <symsurf/points.h>

#include <vector>

namespace symsurf {

/// The layers of a cloud over the positions of a mirror. A mirror that may have any height over
/// each position can lie in the middle of what is there: a solid with one pair of points over each
/// position has such a mirror whatever its shape. Only more pairs over the same position support
/// it.
class MirrorLayers {
 public:
  /// `apart`: how far points over one position may lie from each other along the mirror; `rough`:
  /// how far they may lie off their surface; `size`: how far the cloud extends.
  MirrorLayers(double apart, double rough, double size)
      : apart_(apart), rough_(rough), size_(size) {}

  /// A point of the cloud, the normal of its surface and its image.
  void add(const Vector3& x, const Vector3& normal, const Vector3& image);

  /// 1: the cloud closes around the mirror in a single layer on each side; 0: it has more layers in
  /// many positions, or keeps clear of the mirror.
  double single() const;

 private:
  struct Position {
    Vector3 foot;
    double distance;
  };

  double apart_, rough_, size_;
  std::vector<Position> facing_;  // of surface that faces the mirror
  Index added_ = 0, crossing_ = 0;
};

}  // namespace symsurf
