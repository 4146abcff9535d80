#include "cloud/cloud.h"

#include <symsurf/errors.h>

#include <string>

namespace symsurf {

namespace {

// A cloud thinner than this, against its length, is a line.
constexpr double line_thinness = 1e-8;

// Fourth powers of lengths are computed with, and must be numbers.
constexpr double least_extent = 1e-50, greatest_extent = 1e50;

// In one process: they, and twice as many, are counted in 32 bits.
constexpr Index most_points = Index{1} << 30;

}  // namespace

void require_count(Index given, Index needed) {
  if (given < needed)
    throw InvalidInput(std::to_string(given) + " points given; at least " + std::to_string(needed) +
                       (needed == 1 ? " is needed" : " are needed"));
}

bool is_numerable(Index own) { return own <= most_points; }

void require_numerable(Index own) {
  if (!is_numerable(own))
    throw InvalidInput(std::to_string(own) + " points given; at most " +
                       std::to_string(most_points) + " in one process are allowed");
}

void require_area(PointsView points, Index total) {
  const std::string all = "all " + std::to_string(total) + " points ";
  const Vector3 low = points.matrix().colwise().minCoeff();
  const Vector3 high = points.matrix().colwise().maxCoeff();
  Index longest;
  const double extent = (high - low).maxCoeff(&longest);
  if (!(extent > 0)) throw InvalidInput(all + "are equal");
  if (extent < least_extent || extent > greatest_extent)
    throw InvalidInput("the points extend over " + to_string(Value(extent)) + "; allowed is " +
                       to_string(Value(least_extent)) + " to " + to_string(Value(greatest_extent)));
  Index first, last;
  points.matrix().col(longest).minCoeff(&first);
  points.matrix().col(longest).maxCoeff(&last);
  const Vector3 direction = ((points[last] - points[first]) / extent).normalized();
  // Mostly one of the first points ends the search.
  for (Index i = 0; i < points.size(); ++i) {
    const Vector3 x = (points[i] - points[first]) / extent;
    if ((x - direction.dot(x) * direction).norm() > line_thinness) return;
  }
  throw InvalidInput(all + "lie on one line");
}

bool are_finite(PointsView rows) {
  double sum = 0;  // NaN from the first that is not, without branches
  for (Index i = 0; i < 3 * rows.size(); ++i) sum += 0 * rows.data()[i];
  return sum == 0;
}

void require_finite(PointsView rows, const char* what, Index first) {
  if (are_finite(rows)) return;
  for (Index i = 0; i < rows.size(); ++i)
    if (!rows[i].allFinite())
      throw InvalidInput(std::string(what) + " " + std::to_string(first + i) + " is " +
                         to_string(Value(rows[i])) + "; coordinates must be finite");
}

void require_points(PointsView points) {
  require_count(points.size(), 1);
  require_finite(points, "point");
}

void require_normals(PointsView points, PointsView normals, Index first) {
  if (normals.empty()) return;
  if (normals.size() != points.size())
    throw InvalidInput(std::to_string(normals.size()) + " normals given for " +
                       std::to_string(points.size()) + " points; one a point is needed");
  for (Index i = 0; i < normals.size(); ++i) {
    if (normals[i].allFinite() && !normals[i].isZero(0)) continue;
    if (!points[i].allFinite()) continue;
    throw InvalidInput("normal " + std::to_string(first + i) + " is " +
                       to_string(Value(normals[i])) + "; a finite direction is needed");
  }
}

Cloud checked_cloud(PointsView points, PointsView normals, Index minimum_points,
                    const Context& context) {
  require_count(points.size(), minimum_points);
  require_numerable(points.size());
  require_finite(points, "point");
  require_area(points, points.size());
  require_normals(points, normals);
  const Vector3 low = points.matrix().colwise().minCoeff();
  const Vector3 high = points.matrix().colwise().maxCoeff();
  Cloud cloud;
  cloud.points = points;
  cloud.normals = normals;
  cloud.diagonal = (high - low).norm();
  cloud.frame = principal_frame(points, context);
  cloud.total = points.size();
  return cloud;
}

}  // namespace symsurf
