#pragma once

#include <symsurf/points.h>

#include <vector>

namespace symsurf {

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
