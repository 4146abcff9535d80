#include "detection/shared_cloud.h"

#include <symsurf/errors.h>

#include <string>

#include "base/gathered.h"
#include "base/rows_of.h"
#include "cloud/cloud.h"
#include "cloud/outline.h"

namespace symsurf {

namespace {

// Of each process the point farthest from the line through the lowest and the highest point of all:
// these stand for all points where it is asked whether they lie on one line.
std::vector<Vector3> farthest_from_line(PointsView own, const Vector3& start, const Vector3& end,
                                        const Context& context) {
  const Vector3 direction = (end - start).normalized();
  std::vector<Vector3> farthest;
  double most = -1;
  for (Index i = 0; i < own.size(); ++i) {
    const Vector3 x = own[i] - start;
    const double squared = (x - direction.dot(x) * direction).squaredNorm();
    if (squared <= most) continue;
    most = squared;
    farthest = {own[i]};
  }
  return concatenated(context, farthest);
}

}  // namespace

Cloud checked_shared_cloud(PointsView own, Index minimum_points, const Context& context) {
  const Share share = share_of(context, own.size());
  require_count(share.total, minimum_points);
  check_together(context, [&] {
    require_numerable(own.size());
    require_finite(own, "point", share.first);
  });

  std::vector<Vector3> few = extreme_points(own, context);
  const Vector3 low(few[0].x(), few[2].y(), few[4].z());
  const Vector3 high(few[1].x(), few[3].y(), few[5].z());
  Index axis;
  (high - low).maxCoeff(&axis);
  const auto farthest = farthest_from_line(own, few[2 * axis], few[2 * axis + 1], context);
  few.insert(few.end(), farthest.begin(), farthest.end());
  require_area(rows_of(few), share.total);

  Cloud cloud;
  cloud.points = own;
  cloud.first = share.first;
  cloud.total = share.total;
  cloud.diagonal = (high - low).norm();
  cloud.frame = principal_frame(own, context);
  return cloud;
}

}  // namespace symsurf
