#include "cloud/sheet_noise.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/quantile.h"

namespace symsurf {

namespace {

constexpr double width = 2;  // of a sheet with noise, over the noise's deviation

}  // namespace

std::vector<Vector3> neighbours_of(const std::vector<OnSheet>& samples, const PrincipalFrame& frame,
                                   const NearestPoints& points) {
  std::vector<Vector3> places;
  for (const OnSheet& s : samples) places.push_back(frame.leave(s.position));
  std::vector<Vector3> neighbours = points.second_nearest(places);
  for (Vector3& x : neighbours) x = frame.enter(x);
  return neighbours;
}

SheetNoise::SheetNoise(const std::vector<OnSheet>& samples,
                       const std::vector<Vector3>& neighbours) {
  constexpr double shown = 0.67;  // of it, in the median
  if (samples.empty()) return;
  std::vector<double> offsets;
  for (std::size_t k = 0; k < samples.size(); ++k) {
    const Vector3 chord = neighbours[k] - samples[k].position;
    offsets.push_back(std::abs(chord.dot(samples[k].surfel->normal)));
  }
  deviation_ = median(std::move(offsets)) / shown;
}

bool SheetNoise::shows() const {
  constexpr double noticed = 0.002;
  return deviation_ > noticed;
}

Vector3 SheetNoise::smoothed(const Vector3& x, const Surfel& patch) const {
  return shows() ? patch.smoothed(x, width * deviation_) : x;
}

}  // namespace symsurf
