#include "cloud/outline.h"

#include <algorithm>
#include <memory>

#include "base/gathered.h"
#include "base/rows_of.h"

namespace symsurf {

namespace {

// The lowest and the highest point along each axis: none of no points, else six.
std::vector<Vector3> extreme_points(PointsView points) {
  std::vector<Vector3> extremes;
  for (int axis = 0; axis < 3 && !points.empty(); ++axis) {
    Index low, high;
    points.matrix().col(axis).minCoeff(&low);
    points.matrix().col(axis).maxCoeff(&high);
    extremes.insert(extremes.end(), {points[low], points[high]});
  }
  return extremes;
}

}  // namespace

std::vector<Vector3> extreme_points(PointsView own, const Context& context) {
  std::vector<Vector3> extremes;
  for (const std::vector<Vector3>& part : gathered(context, extreme_points(own))) {
    if (extremes.empty()) {
      extremes = part;
      continue;
    }
    for (std::size_t k = 0; k < part.size(); ++k) {
      const int axis = static_cast<int>(k) / 2;
      const double beyond = part[k][axis] - extremes[k][axis];
      if (k % 2 == 0 ? beyond < 0 : beyond > 0) extremes[k] = part[k];
    }
  }
  return extremes;
}

Points outline(PointsView own, const Context& context) {
  constexpr Index enough = 2000;
  const Share share = share_of(context, own.size());
  const Index step = std::max<Index>(1, share.total / enough);
  std::vector<Vector3> chosen;
  for (Index i = first_of_every(step, share.first); i < own.size(); i += step)
    chosen.push_back(own[i]);
  chosen = concatenated(context, chosen);
  const std::vector<Vector3> extremes = extreme_points(own, context);
  chosen.insert(chosen.end(), extremes.begin(), extremes.end());
  return rows_of(chosen);
}

void set_footprint(Result& result, Points outline) {
  const auto footprint = std::make_shared<const Points>(std::move(outline));
  if (result.mirror) result.mirror->set_footprint(footprint);
  for (Result& candidate : result.candidates)
    if (candidate.mirror) candidate.mirror->set_footprint(footprint);
}

}  // namespace symsurf
