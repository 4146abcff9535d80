#include "score/mirror_sides.h"

#include <algorithm>
#include <cmath>

#include "base/linear_algebra.h"
#include "base/math.h"
#include "cloud/point_tree.h"

namespace symsurf {

namespace {

constexpr double ring = 2.2;           // outer radius, in windows
constexpr double same_way = 0.3;       // cosine between normals of one part of the mirror
constexpr double least_around = 8;     // pairs in a ring
constexpr double most_aside = 0.8;     // of the ring's mean, in windows: else it is extrapolated
constexpr double farthest = 0.6;       // windows: larger errors are no larger
constexpr Index least_predicted = 20;  // pairs
// e^2 / E^2 of random solids, whose sides are smooth and meet: half of them have more.
constexpr double chance_ratio = 0.1;

}  // namespace

// Both are predicted by quadratics through the pairs in the ring around the window. Half the
// distance is predicted by its square, which has no slopes without end where the sides meet.
double MirrorSides::evidence() const {
  Points feet(static_cast<Index>(pairs_.size()), 3);
  for (Index i = 0; i < feet.rows(); ++i) feet.row(i) = pairs_[i].foot.transpose();
  const PointTree tree(feet);
  const double most = farthest * farthest * window_ * window_;
  double middle = 0, half = 0;
  std::vector<Index> predicted;
  std::vector<char> is_predicted(pairs_.size(), 0);
  for (Index i = 0; i < feet.rows(); ++i) {
    const Pair& here = pairs_[i];
    const Eigen::Matrix<double, 3, 2> tangents = orthogonal_to(here.normal);
    QuadraticFit middles, squares;
    Eigen::Vector2d aside = Eigen::Vector2d::Zero();
    tree.within(here.foot, ring * window_, [&](Index k, double squared) {
      const Pair& other = pairs_[k];
      const double cosine = here.normal.dot(other.normal);
      if (squared < window_ * window_ || std::abs(cosine) < same_way) return;
      const Vector3 from_here = other.foot - here.foot;
      const Eigen::Vector2d at = tangents.transpose() * from_here / window_;
      const double upwards = cosine < 0 ? -other.middle : other.middle;
      middles.add(at.x(), at.y(), here.normal.dot(from_here) + upwards);
      squares.add(at.x(), at.y(), other.half * other.half);
      aside += at;
    });
    const double around = middles.weight();
    if (around < least_around || aside.norm() > most_aside * around) continue;
    const double off_middle = here.middle - middles.coefficients()[0];
    const double off_half = (here.half * here.half - squares.coefficients()[0]) / (2 * here.half);
    middle += std::min(off_middle * off_middle, most);
    half += std::min(off_half * off_half, most);
    predicted.push_back(i);
    is_predicted[i] = 1;
  }
  if (static_cast<Index>(predicted.size()) < least_predicted || !(middle > 0)) return 0;
  // Pairs count one a window, in which they lie over the same position and as far apart.
  double windows = 0;
  for (const Index i : predicted) {
    Index alike = 0;
    tree.within(pairs_[i].foot, window_, [&](Index k, double squared) {
      const double farther = pairs_[k].half - pairs_[i].half;
      alike += is_predicted[k] && squared + farther * farther < window_ * window_;
    });
    windows += 1 / static_cast<double>(alike);
  }
  return std::max(0.0, windows / 2 * std::log(chance_ratio * half / middle));
}

}  // namespace symsurf
