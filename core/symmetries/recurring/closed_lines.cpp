#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>

#include "base/eigenvectors.h"
#include "base/math.h"
#include "recurring/recurring_part.h"

namespace symsurf {

namespace {

// Of the components of unit vectors.
constexpr double same_direction = 0.25;

struct Circle {
  Index line;
  Vector3 centre, normal;
  double radius;
  std::vector<Eigen::Vector2d> wings;  // away from the centre, and along the normal
};

// Along the normal the faces beside the circle go on, where one side has more of them.
std::optional<Circle> circle_of(const FeatureLines& graph, Index number, double tolerance) {
  const FeatureLine& line = graph.lines[number];
  Circle circle{number, Vector3::Zero(), Vector3::Zero(), 0, {}};
  for (const Vector3& x : line.samples) circle.centre += x / FeatureLine::steps;
  Points from_centre(FeatureLine::steps, 3);
  for (int k = 0; k < FeatureLine::steps; ++k) from_centre.row(k) = line.samples[k] - circle.centre;
  circle.normal = eigen_of_scatter(from_centre).vectors.col(0);
  circle.radius = from_centre.rowwise().norm().mean();
  for (int k = 0; k < FeatureLine::steps; ++k)
    if (std::abs(from_centre.row(k).norm() - circle.radius) > tolerance ||
        std::abs(from_centre.row(k).dot(circle.normal)) > tolerance)
      return {};
  if (circle.radius < 2 * tolerance) return {};
  double along = 0;
  for (const Vector3& wing : line.wings) along += wing.dot(circle.normal);
  if (along < 0) circle.normal *= -1;
  const Vector3 away = (line.middle() - circle.centre).normalized();
  for (const Vector3& wing : line.wings)
    circle.wings.emplace_back(wing.dot(away), wing.dot(circle.normal));
  return circle;
}

bool are_alike(const Circle& a, const Circle& b, double tolerance) {
  return std::abs(a.radius - b.radius) < tolerance && a.wings.size() == b.wings.size() &&
         std::all_of(a.wings.begin(), a.wings.end(), [&](const Eigen::Vector2d& wing) {
           return std::any_of(b.wings.begin(), b.wings.end(), [&](const Eigen::Vector2d& other) {
             return (wing - other).norm() < same_direction;
           });
         });
}

// A circle, or the two rims of a hole or pin.
struct Rims {
  std::vector<Circle> circles;
  Vector3 centre() const {
    Vector3 sum = Vector3::Zero();
    for (const Circle& circle : circles) sum += circle.centre;
    return sum / static_cast<double>(circles.size());
  }
  double height() const { return (circles.back().centre - circles.front().centre).norm(); }
};

std::vector<Rims> paired(const std::vector<Circle>& circles, double tolerance) {
  const auto partner = [&](std::size_t k) {
    std::size_t nearest = k;
    double least = infinity;
    for (std::size_t other = 0; other < circles.size(); ++other) {
      const Vector3 gap = circles[other].centre - circles[k].centre;
      const double along = gap.dot(circles[k].normal);
      if (other == k || std::abs(circles[other].radius - circles[k].radius) > tolerance ||
          circles[other].normal.dot(circles[k].normal) > same_direction - 1 || along < tolerance ||
          (gap - along * circles[k].normal).norm() > tolerance || along >= least)
        continue;
      least = along;
      nearest = other;
    }
    return nearest;
  };
  std::vector<Rims> found;
  for (std::size_t k = 0; k < circles.size(); ++k) {
    const std::size_t other = partner(k);
    if (other == k || partner(other) != k)
      found.push_back({{circles[k]}});
    else if (k < other)
      found.push_back({{circles[k], circles[other]}});
  }
  return found;
}

// A motion to other rims that turns as little as can be, with their lines in the order of these.
std::optional<RecurringPart::Instance> taken_to(const Rims& from, const Rims& onto,
                                                double tolerance) {
  if (from.circles.size() != onto.circles.size() ||
      std::abs(from.height() - onto.height()) > tolerance)
    return {};
  std::optional<RecurringPart::Instance> best;
  double most = -infinity;
  std::vector<Circle> circles = onto.circles;
  for (int order = 0; order < 2; ++order) {
    bool alike = true;
    for (std::size_t k = 0; k < circles.size(); ++k)
      alike = alike && are_alike(from.circles[k], circles[k], tolerance);
    const double cosine = from.circles[0].normal.dot(circles[0].normal);
    if (alike && cosine > most) {
      most = cosine;
      RecurringPart::Instance instance;
      const Matrix3 turn = least_rotation(from.circles[0].normal, circles[0].normal);
      instance.map = map_taking(turn, from.centre(), onto.centre());
      for (const Circle& circle : circles) instance.lines.push_back(circle.line);
      best = instance;
    }
    std::reverse(circles.begin(), circles.end());
  }
  return best;
}

}  // namespace

std::vector<RecurringPart> closed_line_parts(const FeatureLines& graph, double tolerance,
                                             const Context& context) {
  std::vector<Circle> circles;
  for (std::size_t k = 0; k < graph.lines.size(); ++k)
    if (!graph.lines[k].has_ends())
      if (const auto circle = circle_of(graph, static_cast<Index>(k), tolerance))
        circles.push_back(*circle);
  constexpr std::size_t most = 2000;  // pairs are compared
  if (circles.size() > most) circles.resize(most);
  context.check();
  const std::vector<Rims> all = paired(circles, tolerance);
  std::vector<RecurringPart> parts;
  std::vector<char> used(all.size(), 0);
  for (std::size_t k = 0; k < all.size(); ++k) {
    if (used[k]) continue;
    context.check();
    RecurringPart part;
    for (const Circle& circle : all[k].circles) {
      part.lines.push_back(circle.line);
      part.length += graph.lines[circle.line].length;
    }
    part.instances.push_back({Eigen::Isometry3d::Identity(), part.lines});
    for (std::size_t other = k + 1; other < all.size(); ++other)
      if (!used[other])
        if (auto instance = taken_to(all[k], all[other], tolerance)) {
          used[other] = 1;
          part.instances.push_back(std::move(*instance));
        }
    if (part.instances.size() > 1) parts.push_back(std::move(part));
  }
  return parts;
}

}  // namespace symsurf
