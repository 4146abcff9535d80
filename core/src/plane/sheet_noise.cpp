#include "sheet_noise.h"

#include <algorithm>
#include <utility>

#include "../quantile.h"

namespace symsurf {

namespace {

constexpr double width = 2;  // of a sheet with noise, over the noise's deviation

}  // namespace

SheetNoise::SheetNoise(std::vector<double> offsets) {
  constexpr double shown = 0.67;  // of it, in the median
  deviation_ = median(std::move(offsets)) / shown;
}

SheetNoise::SheetNoise(std::vector<double> offsets, const Surfels& patches)
    : SheetNoise(std::move(offsets)) {
  constexpr double thin = 0.25;  // of the patches: others are curved, or hold two sheets
  if (!shows()) return;
  std::vector<double> thicknesses;
  for (Index k = 0; k < patches.size(); ++k) thicknesses.push_back(patches[k].thickness);
  deviation_ = std::max(deviation_, quantile(std::move(thicknesses), thin));
}

bool SheetNoise::shows() const {
  constexpr double noticed = 0.002;
  return deviation_ > noticed;
}

bool SheetNoise::explains(const Surfel& patch) const {
  return patch.thickness < width * deviation_;
}

Vector3 SheetNoise::smoothed(const Vector3& x, const Surfel& patch) const {
  return shows() ? patch.smoothed(x, width * deviation_) : x;
}

}  // namespace symsurf
