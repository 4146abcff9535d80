#pragma once

#include <symsurf/types.h>

#include <vector>

namespace symsurf {

/// The layers of a cloud over the places of a mirror. A mirror that may have any height over each
/// place can lie in the middle of what is there: a solid with one pair of points over each place
/// has such a mirror whatever its shape. Only more pairs over the same place speak for it.
class MirrorLayers {
 public:
  /// `apart`: how far points over one place may lie from each other along the mirror; `rough`: how
  /// far they may lie off their surface; `size`: how far the cloud extends.
  MirrorLayers(double apart, double rough, double size)
      : apart_(apart), rough_(rough), size_(size) {}

  /// A point of the cloud, the normal of its surface and its image.
  void add(const Vector3& x, const Vector3& normal, const Vector3& image);

  /// 1: the cloud closes around the mirror in a single layer on each side; 0: it has more layers in
  /// many places, or keeps clear of the mirror.
  double single() const;

 private:
  struct Place {
    Vector3 foot;
    double distance;
  };

  double apart_, rough_, size_;
  std::vector<Place> facing_;  // of surface that faces the mirror
  Index added_ = 0, crossing_ = 0;
};

}  // namespace symsurf
