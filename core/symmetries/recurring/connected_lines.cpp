#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <queue>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include "base/linear_algebra.h"
#include "base/math.h"
#include "recurring/recurring_parts.h"

namespace symsurf {

std::vector<LineChain> line_chains(const std::vector<std::array<Index, 2>>& ends,
                                   const std::vector<std::vector<Index>>& at,
                                   const std::vector<Index>& corner) {
  std::vector<LineChain> chains;
  std::vector<char> used(ends.size(), 0);
  const auto follow = [&](Index start, Index edge) {
    LineChain chain{{start}, {}};
    for (;;) {
      used[edge] = 1;
      chain.edges.push_back(edge);
      const Index node = ends[edge][ends[edge][0] == chain.nodes.back() ? 1 : 0];
      chain.nodes.push_back(node);
      if (corner[node] >= 0 || node == start) break;
      edge = at[node][at[node][0] == edge ? 1 : 0];
    }
    chains.push_back(std::move(chain));
  };
  for (std::size_t node = 0; node < at.size(); ++node)
    if (corner[node] >= 0)
      for (const Index edge : at[node])
        if (!used[edge]) follow(static_cast<Index>(node), edge);
  for (std::size_t edge = 0; edge < ends.size(); ++edge)
    if (!used[edge] && ends[edge][0] >= 0) follow(ends[edge][0], static_cast<Index>(edge));
  return chains;
}

std::size_t sample_along(const std::vector<Vector3>& nodes, FeatureLine& line) {
  std::vector<double> reached{0};
  for (std::size_t k = 1; k < nodes.size(); ++k)
    reached.push_back(reached.back() + (nodes[k] - nodes[k - 1]).norm());
  line.length = reached.back();
  std::size_t k = 1, middle = 1;
  for (int step = 0; step < FeatureLine::steps; ++step) {
    const double at = line.length * step / FeatureLine::steps;
    while (k + 1 < nodes.size() && reached[k] < at) ++k;
    const double edge = reached[k] - reached[k - 1];
    const double share = edge > 0 ? (at - reached[k - 1]) / edge : 0;
    line.samples[step] = (1 - share) * nodes[k - 1] + share * nodes[k];
    if (step == FeatureLine::steps / 2) middle = k;
  }
  return middle;
}

void connect(FeatureLines& graph) {
  graph.at.assign(graph.corners.size(), {});
  for (std::size_t number = 0; number < graph.lines.size(); ++number) {
    const FeatureLine& line = graph.lines[number];
    if (!line.has_ends()) continue;
    graph.at[line.start].push_back(static_cast<Index>(number));
    if (line.end != line.start) graph.at[line.end].push_back(static_cast<Index>(number));
  }
}

namespace {

// Radians between the image of a direction across a line and its partner: 15 degrees. What is
// between the edges of a bent line on both sides of its middle must not matter. And with noise.
constexpr double same_wing = 0.262, most_turned = 0.785;

// In standard deviations.
constexpr double noise_of_ends = 4, noise_of_wings = 3;

// Of its length, how far a short line may be off.
constexpr double of_length = 0.1;

// Pairs of lines, of all matches: some 3 s. A gear of 200 teeth takes 8 million, random triangles
// whose corners all lie within the tolerance take as many as they may.
constexpr std::size_t most_compared = 50'000'000;

Vector3 sample(const FeatureLine& line, const Vector3& end, int step, bool reversed) {
  if (!reversed) return line.samples[step];
  return step == 0 ? end : line.samples[FeatureLine::steps - step];
}

// An orthonormal basis by the line and the faces beside it; not right-handed where reflected.
Matrix3 basis(const Vector3& from, const Vector3& to, const std::vector<Vector3>& wings,
              LineMatching::Pose pose) {
  Matrix3 axes;
  axes.col(0) = (pose.reversed ? from - to : to - from).normalized();
  Vector3 across = Vector3::Zero();
  for (const Vector3& wing : wings) across += wing;
  constexpr double vanishing = 0.1;  // where three faces are spread evenly around the line
  if (across.norm() < vanishing) across = wings.front();
  axes.col(1) = (across - across.dot(axes.col(0)) * axes.col(0)).normalized();
  axes.col(2) = axes.col(0).cross(axes.col(1));
  if (pose.reflected) axes.col(2) *= -1;
  return axes;
}

}  // namespace

double LineMatch::plainness() const {
  const double trace = map.linear().trace();
  return map.linear().determinant() > 0 ? trace + 10 : trace;
}

bool LineMatching::agrees(const Eigen::Isometry3d& map, const FeatureLine& line,
                          const FeatureLine& image, bool reversed) const {
  const double near =
      std::min(tolerance_, std::max(of_length * line.length, noise_of_ends * graph_.noise));
  if (std::abs(line.length - image.length) > 2 * near || line.wings.size() != image.wings.size() ||
      line.has_ends() != image.has_ends())
    return false;
  if (line.has_ends()) {
    const Vector3 &start = graph_.corners[image.start], &end = graph_.corners[image.end];
    if ((map * graph_.corners[line.start] - (reversed ? end : start)).norm() > tolerance_ ||
        (map * graph_.corners[line.end] - (reversed ? start : end)).norm() > near)
      return false;
    for (int step = 1; step < FeatureLine::steps; ++step)
      if ((map * line.samples[step] - sample(image, end, step, reversed)).norm() > near)
        return false;
  }
  const double cosine = std::cos(std::min(
      most_turned, same_wing + noise_of_wings * std::hypot(line.wing_error, image.wing_error)));
  for (const Vector3& wing : line.wings) {
    const Vector3 turned = map.linear() * wing;
    if (std::none_of(image.wings.begin(), image.wings.end(),
                     [&](const Vector3& other) { return turned.dot(other) > cosine; }))
      return false;
  }
  return true;
}

std::vector<std::pair<Index, Index>> LineMatching::reached(const Eigen::Isometry3d& map, Index line,
                                                           Index image, bool reversed) {
  std::vector<std::pair<Index, Index>> pairs;
  std::unordered_map<Index, Index> corners, back;
  std::unordered_set<Index> lines, images;
  std::vector<Index> open;
  const auto can_be = [&](Index corner, Index onto) {
    const auto known = corners.find(corner), taken = back.find(onto);
    return (known == corners.end() || known->second == onto) &&
           (taken == back.end() || taken->second == corner);
  };
  const auto add = [&](Index from, Index onto, bool is_reversed) {
    const FeatureLine &a = graph_.lines[from], &b = graph_.lines[onto];
    const Index start = is_reversed ? b.end : b.start, end = is_reversed ? b.start : b.end;
    if (!can_be(a.start, start) || !can_be(a.end, end) || !agrees(map, a, b, is_reversed))
      return false;
    for (const auto& [corner, other] : {std::pair(a.start, start), std::pair(a.end, end)}) {
      back.emplace(other, corner);
      if (corners.emplace(corner, other).second) open.push_back(corner);
    }
    lines.insert(from);
    images.insert(onto);
    pairs.emplace_back(from, onto);
    return true;
  };
  if (!add(line, image, reversed)) return pairs;
  for (std::size_t k = 0; k < open.size(); ++k)
    for (const Index from : graph_.at[open[k]]) {
      if (taken_[from] || lines.count(from)) continue;
      if (compared_ > most_compared) return pairs;
      compared_ += graph_.at[corners[open[k]]].size();
      for (const Index onto : graph_.at[corners[open[k]]]) {
        if (taken_[onto] || images.count(onto)) continue;
        if (add(from, onto, false) || add(from, onto, true)) break;
      }
    }
  return pairs;
}

Eigen::Isometry3d LineMatching::fitted(const LineMatch& match) const {
  std::vector<std::pair<Vector3, Vector3>> pairs;
  for (const auto& [from, onto] : match.lines) {
    const FeatureLine &line = graph_.lines[from], &image = graph_.lines[onto];
    const Vector3 start = match.map * graph_.corners[line.start];
    const Vector3 middle = match.map * line.samples[1];
    const bool reversed = line.start == line.end ? (middle - image.samples[1]).norm() >
                                                       (middle - image.samples.back()).norm()
                                                 : (start - graph_.corners[image.start]).norm() >
                                                       (start - graph_.corners[image.end]).norm();
    for (int step = 0; step < FeatureLine::steps; ++step)
      pairs.emplace_back(line.samples[step],
                         sample(image, graph_.corners[image.end], step, reversed));
  }
  return nearest_isometry(pairs, match.map.linear().determinant() > 0 ? 1 : -1);
}

std::optional<LineMatch> LineMatching::grown(Index line, Index image, Pose pose) {
  const FeatureLine &one = graph_.lines[line], &other = graph_.lines[image];
  const Vector3 &start = graph_.corners[one.start], &end = graph_.corners[one.end];
  LineMatch match;
  if (line != image || pose.reversed || pose.reflected) {
    const Matrix3 before = basis(start, end, one.wings, {false, false});
    const Matrix3 after =
        basis(graph_.corners[other.start], graph_.corners[other.end], other.wings, pose);
    match.map = map_taking(after * before.transpose(), (start + end) / 2,
                           (graph_.corners[other.start] + graph_.corners[other.end]) / 2);
  }
  constexpr int rounds = 5;
  for (int round = 0; round < rounds; ++round) {
    std::vector<std::pair<Index, Index>> lines = reached(match.map, line, image, pose.reversed);
    if (lines.size() <= match.lines.size()) break;
    match.lines = std::move(lines);
    const bool is_own = line == image && !pose.reversed && !pose.reflected;
    if (is_own || match.lines.size() < 2) break;  // one line would be free to turn
    match.map = fitted(match);
  }
  if (match.lines.empty()) return {};
  return match;
}

ConnectedLines::ConnectedLines(const FeatureLines& graph, const LineMatch& own)
    : graph_(graph), local_(graph.lines.size(), -1) {
  for (const auto& [line, image] : own.lines) {
    local_[line] = static_cast<std::int32_t>(lines_.size());
    lines_.push_back(line);
  }
}

LocalMatch ConnectedLines::local(const LineMatch& match) const {
  LocalMatch local{match.map, std::vector<std::int32_t>(size(), -1)};
  for (const auto& [line, image] : match.lines) {
    local.images[local_[line]] = static_cast<std::int32_t>(image);
    local.length += graph_.lines[line].length;
  }
  return local;
}

LocalMatch ConnectedLines::after(const LocalMatch& second, const LocalMatch& first) const {
  LocalMatch both{second.map * first.map, std::vector<std::int32_t>(size(), -1)};
  for (std::size_t line = 0; line < size(); ++line) {
    const std::int32_t image = first.images[line], own = image < 0 ? -1 : local_[image];
    if (own >= 0) both.images[line] = second.images[own];
  }
  return both;
}

template <typename Visit>
void ConnectedLines::for_each_next(std::int32_t local, const Visit& visit) const {
  for (const Index corner : {line(local).start, line(local).end})
    for (const Index next : graph_.at[corner])
      if (local_[next] >= 0) visit(local_[next]);
}

LocalLines ConnectedLines::common(const std::vector<const LocalMatch*>& matches,
                                  double share) const {
  LocalLines found;
  std::vector<char> seen(size(), 0);
  const auto visit = [&](std::int32_t line) {
    if (seen[line]) return;
    seen[line] = 1;
    const auto having = std::count_if(matches.begin(), matches.end(), [&](const LocalMatch* match) {
      return match->images[line] >= 0;
    });
    if (static_cast<double>(having) >= share * static_cast<double>(matches.size()))
      found.push_back(line);
  };
  visit(0);
  for (std::size_t k = 0; k < found.size(); ++k) for_each_next(found[k], visit);
  return found;
}

LocalLines ConnectedLines::disjoint(const std::vector<const LocalMatch*>& matches,
                                    std::int32_t start, const Vector3& point, double share) const {
  using Step = std::pair<double, std::int32_t>;
  std::priority_queue<Step, std::vector<Step>, std::greater<>> steps;
  std::vector<char> seen(size(), 0), claimed(graph_.lines.size(), 0);
  const auto visit = [&](std::int32_t line) {
    if (seen[line]) return;
    seen[line] = 1;
    steps.push({(middle(line) - point).norm(), line});
  };
  LocalLines part;
  visit(start);
  while (!steps.empty()) {
    const std::int32_t line = steps.top().second;
    steps.pop();
    LocalLines images;
    bool is_free = true;
    for (const LocalMatch* match : matches) {
      const std::int32_t image = match->images[line];
      if (image < 0) continue;
      is_free = !claimed[image];
      if (!is_free) break;
      claimed[image] = 1;
      images.push_back(image);
    }
    if (!is_free ||
        static_cast<double>(images.size()) < share * static_cast<double>(matches.size())) {
      for (const std::int32_t image : images) claimed[image] = 0;
      continue;
    }
    part.push_back(line);
    for_each_next(line, visit);
  }
  return part;
}

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
