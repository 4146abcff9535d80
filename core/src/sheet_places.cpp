#include "sheet_places.h"

#include <algorithm>
#include <cmath>

namespace symsurf {

namespace {

// A point on the plane of a patch.
struct Projected {
  Vector3 place;
  double spread;  // squared: of the patch along its plane, less the place's own from its middle

  Projected(const Vector3& x, const Surfel& patch)
      : place(x - patch.normal * patch.normal.dot(x - patch.mean)),
        spread(patch.covariance.trace() - patch.thickness * patch.thickness -
               (place - patch.mean).squaredNorm()) {}
};

}  // namespace

SheetPlaces::SheetPlaces(const Surfels& coarse, const Surfels& fine, const SheetNoise& noise,
                         Index points)
    : coarse_(&coarse), fine_(&fine), noise_(noise) {
  constexpr double least = 0.14, most = 0.7;
  const double points_a_patch = static_cast<double>(points) / static_cast<double>(coarse.size());
  left_ = noise.deviation() * std::clamp(1 / std::sqrt(2 * points_a_patch), least, most);
}

Located SheetPlaces::at(const Vector3& x, NoiseIs noise) const {
  switch (noise_.shows() ? noise : NoiseIs::kept) {
    case NoiseIs::smoothed:
      return smoothed(x);
    case NoiseIs::extrapolated:
      return extrapolated(x);
    default:
      return {x};
  }
}

Located SheetPlaces::smoothed(const Vector3& x) const {
  const Surfel* patch = flattest_at({coarse_, fine_}, x);
  return {patch ? noise_.smoothed(x, *patch) : x, left_};
}

// A plane's distance from the sheet is proportional to the spread of its patch.
Located SheetPlaces::extrapolated(const Vector3& x) const {
  constexpr double doubtful = 0.5;  // of what is extrapolated
  const Index fine = fine_->containing(x), coarse = coarse_->containing(x);
  if (fine < 0 || !noise_.explains((*fine_)[fine])) return {x, noise_.deviation()};
  const Projected narrow(x, (*fine_)[fine]);
  if (coarse < 0) return {narrow.place, noise_.deviation()};
  const Projected wide(x, (*coarse_)[coarse]);
  if (narrow.spread <= 0 || wide.spread < 2 * narrow.spread)
    return {narrow.place, noise_.deviation()};
  const Vector3 further =
      (narrow.place - wide.place) * (narrow.spread / (wide.spread - narrow.spread));
  return {narrow.place + further,
          std::min(noise_.deviation(), std::hypot(left_, doubtful * further.norm()))};
}

}  // namespace symsurf
