#include "cloud/surface_noise.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/math.h"

namespace symsurf {

namespace {

constexpr double width = 2;  // of a surface with noise, over the noise's deviation

}  // namespace

std::vector<Vector3> neighbours_of(const std::vector<OnSurface>& samples,
                                   const PrincipalFrame& frame, const NearestPoints& points) {
  std::vector<Vector3> positions;
  for (const OnSurface& s : samples) positions.push_back(frame.from_frame(s.position));
  std::vector<Vector3> neighbours = points.second_nearest(positions);
  for (Vector3& x : neighbours) x = frame.to_frame(x);
  return neighbours;
}

SurfaceNoise::SurfaceNoise(const std::vector<OnSurface>& samples,
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

bool SurfaceNoise::shows() const {
  constexpr double noticed = 0.002;
  return deviation_ > noticed;
}

Vector3 SurfaceNoise::smoothed(const Vector3& x, const Surfel& patch) const {
  return shows() ? patch.smoothed(x, width * deviation_) : x;
}

}  // namespace symsurf
