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

/// The two sides of a cloud over a mirror of any shape: where their middle lies and how far apart
/// they are. The middle of sides that have nothing in common is as rough as their distance; that of
/// sides that mirror each other is smoother by far.
class MirrorSides {
 public:
  /// What one point contributes.
  struct Pair {
    Vector3 foot;    ///< on the mirror
    Vector3 normal;  ///< the mirror's, of either sign
    double middle;   ///< of the two sides, above the foot along the normal
    double half;     ///< half the distance between them
  };

  /// `window`: the radius of what is held out, over which both are predicted.
  explicit MirrorSides(double window) : window_(window) {}

  void add(const Pair& pair) { pairs_.push_back(pair); }

  /// The evidence of the pairs for a mirror, against chance, in nats: with e^2 and E^2 the mean
  /// square errors of the middle and of half the distance when they are held out, and n
  /// independent windows, n / 2 ln(r E^2 / e^2), and 0 at least. r is what chance reaches.
  double evidence() const;

 private:
  double window_;
  std::vector<Pair> pairs_;
};

}  // namespace symsurf
