#include "symmetries/symmetry_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include "base/math.h"
#include "methods/plane/plane_candidates.h"
#include "score/mirror_score.h"
#include "spatial/point_tree.h"
#include "symmetries/orbit_vote.h"
#include "symmetries/point_group.h"
#include "symmetries/symmetry_fit.h"

namespace symsurf {

namespace {

constexpr Index surfels = 1000;
// Where a part is cut away no element scores 1: one may map the hole beside itself, and another
// leave out twice as much as the best does. Beyond that scores differ by this.
constexpr double below_best = 0.05;
constexpr double below_axis = 0.06;  // of the best turns about the same axis
constexpr double glance_tolerance = 0.03, glance_support = 0.4;
constexpr double rough_tolerance = 0.015, rough_support = 0.45;
constexpr std::size_t most_planes = 12;      // fitted to the full cloud; a few tell of all others
constexpr std::size_t most_directions = 40;  // of axes that are tried
constexpr double same_direction = 0.05;      // radians, of axes fitted well: 3 degrees
constexpr double same_guess = 0.035;
constexpr std::array<Index, 11> primes{2, 3, 5, 7, 11, 13, 17, 19, 23, 29, 31};
constexpr Index greatest_power = 64;
constexpr Index greatest_order = 128;  // a body of which more orders hold is one of revolution
constexpr std::size_t samples = 1500;  // a step, for one element

const Matrix3 mirror_across = reflection(Vector3::UnitZ());

Matrix3 turned(double share) { return turn(Vector3::UnitZ(), 2 * std::numbers::pi * share); }

// Turns by k / order of a full turn, a few of those that no lesser order has.
std::vector<Matrix3> turns_of(Index order) {
  std::vector<Matrix3> turns;
  const Index step = std::max<Index>(1, order / 6);
  for (Index k = 1; 2 * k <= order && turns.size() < 3; k += step)
    turns.push_back(turned(static_cast<double>(k) / static_cast<double>(order)));
  return turns;
}

// Turns that are those of no order up to hundreds.
std::vector<Matrix3> any_turns() {
  std::vector<Matrix3> turns;
  for (int k = 1; k <= 4; ++k) turns.push_back(turned(k * std::numbers::phi));
  return turns;
}

bool are_parallel(const Vector3& a, const Vector3& b, double angle) {
  return a.cross(b).norm() < angle;
}

// Of a pose whose x is to point along a direction, which is laid across z.
GroupPose with_x(GroupPose pose, const Vector3& x) {
  const Vector3 z = pose.axes.col(2), across = (x - x.dot(z) * z).normalized();
  pose.axes << across, z.cross(across), z;
  return pose;
}

class SymmetrySearch {
 public:
  SymmetrySearch(const Cloud& cloud, double minimum_score, const Context& context)
      : cloud_(cloud),
        context_(context),
        minimum_score_(minimum_score),
        tree_(cloud.points, context.stage(0, 0.1)),
        points_(cloud.points, tree_, context.stage(0.1, 0.1)),
        coarse_(cloud, surfels, context.stage(0.1, 0.2)),
        fine_(cloud, coarse_, context.stage(0.2, 0.3)),
        score_(cloud, points_, context.stage(0.3, 0.4)),
        fit_(cloud, points_, coarse_, fine_) {}

  Symmetries run() {
    find_planes();
    context_.report(0.5);
    place_centre();
    find_axes();
    context_.report(0.8);
    for (const auto& propose :
         {&SymmetrySearch::spherical, &SymmetrySearch::polyhedral, &SymmetrySearch::axial})
      if (const std::optional<Placed> placed = (this->*propose)())
        if (std::optional<Symmetries> found = verified(*placed)) return *found;
    for (const Direction& plane : planes_)
      if (is_symmetry(plane.score))
        if (std::optional<Symmetries> found = verified({reflection_group(), plane.pose}))
          return *found;
    if (std::optional<Symmetries> found =
            verified({inversion_group(), fitted({}, {-Matrix3::Identity()})}))
      return *found;
    return described({{}, {}}, 1);
  }

 private:
  // A direction with what it is the axis of.
  struct Direction {
    GroupPose pose;  // z along it
    double score = 0;
    Index order = 1;  // 0: continuous
    Vector3 z() const { return pose.axes.col(2); }
  };
  struct Placed {
    PointGroup group;
    GroupPose pose;
  };

  bool is_symmetry(double score) const {
    return score >= std::max(minimum_score_, best_ - (1 - best_) - below_best);
  }

  double score_of(const GroupPose& pose, const std::vector<Matrix3>& elements) const {
    double least = 1;
    for (const Matrix3& element : elements) {
      least = std::min(least, orbit_vote(score_, pose, {element}).share());
      if (least < minimum_score_) break;
    }
    return least;
  }

  GroupPose fitted(const GroupPose& pose, const std::vector<Matrix3>& elements) const {
    return fit_.closely(fit_.roughly(pose, elements), elements, samples);
  }

  // The pose fitted to the elements, where these may be symmetries, with their least score.
  std::optional<Direction> tried(const GroupPose& start,
                                 const std::vector<Matrix3>& elements) const {
    for (const Matrix3& element : elements)
      if (fit_.support(start, element, glance_tolerance) < glance_support) return {};
    GroupPose pose = fit_.roughly(start, elements);
    for (const Matrix3& element : elements)
      if (fit_.support(pose, element, rough_tolerance) < rough_support) return {};
    pose = fit_.closely(pose, elements, samples);
    const double score = score_of(pose, elements);
    if (score < minimum_score_) return {};
    return Direction{pose, score};
  }

  void find_planes() {
    const SurfelMap map(coarse_);
    std::vector<GroupPose> starts;
    for (int axis = 0; axis < 3; ++axis)
      starts.push_back(GroupPose::along(Vector3::Unit(axis), Vector3::Zero()));
    for (const PlaneCandidate& candidate : candidate_planes(coarse_, map, usual_search, 40))
      starts.push_back(GroupPose::along(candidate.shape.normal,
                                        -candidate.shape.offset * candidate.shape.normal));
    std::vector<std::pair<double, GroupPose>> rough;
    for (const GroupPose& start : starts) {
      const GroupPose pose = fit_.roughly(start, {mirror_across});
      const double support = fit_.support(pose, mirror_across, rough_tolerance);
      if (support >= rough_support) rough.emplace_back(support, pose);
    }
    std::stable_sort(rough.begin(), rough.end(),
                     [](const auto& a, const auto& b) { return a.first > b.first; });
    suppress_non_maxima(rough, most_planes, [](const auto& a, const auto& b) {
      return are_parallel(a.second.axes.col(2), b.second.axes.col(2), same_guess);
    });
    for (const auto& [support, start] : rough) {
      const GroupPose pose = fit_.closely(start, {mirror_across}, samples);
      const double score = score_of(pose, {mirror_across});
      if (score >= minimum_score_) planes_.push_back({pose, score});
      best_ = std::max(best_, score);
    }
    std::stable_sort(planes_.begin(), planes_.end(),
                     [](const Direction& a, const Direction& b) { return a.score > b.score; });
    suppress_non_maxima(planes_, planes_.size(), [](const Direction& a, const Direction& b) {
      return are_parallel(a.z(), b.z(), same_direction);
    });
    std::erase_if(planes_, [this](const Direction& plane) { return !is_symmetry(plane.score); });
  }

  // Nearest to all planes, and where these leave it free to the centroid.
  void place_centre() {
    constexpr double free = 1e-6;
    Matrix3 products = free * Matrix3::Identity();
    Vector3 sum = Vector3::Zero();
    for (const Direction& plane : planes_) {
      products += plane.z() * plane.z().transpose();
      sum += plane.z().dot(plane.pose.centre) * plane.z();
    }
    centre_ = products.ldlt().solve(sum);
  }

  std::vector<Vector3> axis_guesses() const {
    std::vector<Vector3> guesses;
    for (int axis = 0; axis < 3; ++axis) guesses.push_back(Vector3::Unit(axis));
    for (std::size_t i = 0; i < planes_.size(); ++i)
      for (std::size_t j = 0; j < i; ++j) {
        const Vector3 line = planes_[i].z().cross(planes_[j].z());
        if (line.norm() > same_direction) guesses.push_back(line.normalized());
      }
    for (const Direction& plane : planes_) guesses.push_back(plane.z());
    suppress_non_maxima(guesses, most_directions, [](const Vector3& a, const Vector3& b) {
      return are_parallel(a, b, same_guess);
    });
    return guesses;
  }

  void find_axes() {
    for (const Vector3& guess : axis_guesses()) {
      const bool is_known = std::any_of(axes_.begin(), axes_.end(), [&](const Direction& axis) {
        return are_parallel(axis.z(), guess, same_direction);
      });
      if (is_known) continue;
      const GroupPose start = GroupPose::along(guess, centre_);
      std::optional<Direction> axis = tried(start, any_turns());
      if (axis) {
        axis->order = 0;
        best_ = std::max(best_, axis->score);
        if (axis->score >= best_ - below_best) {
          axes_.push_back(*axis);
          break;  // what else there is, spherical() and axial() find
        }
      }
      // Of a gear any turn maps the faces onto themselves, and some the teeth, too.
      const std::optional<Direction> finite = finite_axis(start);
      if (finite &&
          (!axis || !is_symmetry(axis->score) || finite->score > axis->score + below_best))
        axis = finite;
      if (axis) axes_.push_back(*axis);
    }
    std::erase_if(axes_, [this](const Direction& axis) { return !is_symmetry(axis.score); });
    std::stable_sort(axes_.begin(), axes_.end(), [](const Direction& a, const Direction& b) {
      return rank(a.order) > rank(b.order);
    });
  }

  static Index rank(Index order) { return order == 0 ? 1 << 20 : order; }

  // Of the order that all turns about it make that score like the best of them.
  std::optional<Direction> finite_axis(const GroupPose& start) {
    std::vector<std::pair<Index, Direction>> found;  // with the prime
    for (const Index prime : primes)
      for (Index power = prime; power <= greatest_power; power *= prime) {
        std::optional<Direction> axis = tried(start, turns_of(power));
        if (!axis) break;
        axis->order = power;
        best_ = std::max(best_, axis->score);
        found.emplace_back(prime, *axis);
      }
    double most = 0;
    for (const auto& [prime, axis] : found) most = std::max(most, axis.score);
    std::optional<Direction> whole;
    for (const auto& [prime, axis] : found) {
      if (!is_symmetry(axis.score) || axis.score < most - below_axis) continue;
      if (!whole) {
        whole = axis;
        continue;
      }
      whole->order *= whole->order % prime == 0 ? prime : axis.order;
      whole->score = std::min(whole->score, axis.score);
    }
    if (whole && whole->order > greatest_order) return {};
    return whole;
  }

  std::optional<Placed> spherical() {
    if (axes_.empty() || axes_.front().order != 0) return {};
    const Direction& axis = axes_.front();
    const GroupPose across = GroupPose::along(Vector3(axis.pose.axes.col(0)), axis.pose.centre);
    const std::optional<Direction> other = tried(across, any_turns());
    if (!other || !is_symmetry(other->score)) return {};
    return Placed{spherical_group(), other->pose};
  }

  std::optional<Placed> polyhedral() {
    if (axes_.size() < 2 || axes_[1].order < 3 || axes_[0].order == 0 || axes_[0].order > 5)
      return {};
    const Index order = axes_[0].order;
    const Vector3 a = axes_[0].z();
    // Another of the highest order: found, or the first turned about one of another order.
    const Vector3 b =
        axes_[1].order == order
            ? axes_[1].z()
            : turn(axes_[1].z(), 2 * std::numbers::pi / static_cast<double>(axes_[1].order)) * a;
    const PointGroup turns = polyhedral_group(order, false, false);
    std::vector<Vector3> ideal;
    for (const PointGroup::Axis& axis : turns.axes())
      if (axis.order == order) ideal.push_back(axis.direction);
    std::optional<GroupPose> pose;
    double nearest = same_direction;
    for (std::size_t k = 1; k < ideal.size(); ++k) {
      const double cosine = ideal[0].dot(ideal[k]);
      const double off = std::abs(std::abs(cosine) - std::abs(a.dot(b)));
      if (off >= nearest) continue;
      nearest = off;
      const Vector3 other = cosine * a.dot(b) < 0 ? Vector3(-ideal[k]) : ideal[k];
      const auto basis = [](const Vector3& u, const Vector3& v) {
        Matrix3 m;
        m << u, u.cross(v).normalized(), u.cross(u.cross(v).normalized());
        return m;
      };
      pose = GroupPose{basis(a, b) * basis(ideal[0], other).transpose(), centre_};
    }
    if (!pose) return {};
    const auto has = [&](const Matrix3& element) {
      const std::optional<Direction> found = tried(*pose, {element});
      return found && is_symmetry(found->score);
    };
    const bool inversion = has(-Matrix3::Identity());
    const bool mirror = !inversion && order == 3 && has(reflection(Vector3(1, -1, 0)));
    return Placed{polyhedral_group(order, inversion, mirror), *pose};
  }

  std::optional<Placed> axial() {
    if (axes_.empty()) return {};
    std::optional<Placed> most;
    for (const Direction& axis : axes_) {
      if (rank(axis.order) < rank(axes_.front().order)) break;
      const Placed placed = about(axis);
      if (!most || placed.group.elements.size() > most->group.elements.size()) most = placed;
    }
    return most;
  }

  // All that there is beside the turns about an axis.
  Placed about(const Direction& axis) {
    const auto order = static_cast<double>(std::max<Index>(1, axis.order));
    AxialElements has;
    const auto holds = [&](const GroupPose& pose, const Matrix3& element) {
      const std::optional<Direction> found = tried(pose, {element});
      return found && is_symmetry(found->score);
    };
    has.across = holds(axis.pose, mirror_across);
    has.rotary =
        axis.order != 0 && !has.across && holds(axis.pose, turned(1 / (2 * order)) * mirror_across);
    GroupPose pose = axis.pose;
    const Matrix3 mirror = reflection(Vector3::UnitX());
    const Matrix3 half_turn = turn(Vector3::UnitX(), std::numbers::pi);
    if (const std::optional<GroupPose> found = scanned(axis, mirror)) {
      has.vertical = true;
      pose = *found;
    } else if (const std::optional<GroupPose> other = scanned(axis, half_turn)) {
      has.twofold = true;
      pose = *other;
    }
    return {axial_group(axis.order, has), pose};
  }

  // The pose turned about its z to where the element along x is a symmetry.
  std::optional<GroupPose> scanned(const Direction& axis, const Matrix3& element) const {
    constexpr int steps = 12;
    const Index order = std::max<Index>(1, axis.order);
    const double period = std::numbers::pi / static_cast<double>(order);
    std::vector<std::pair<double, GroupPose>> starts;
    const auto add = [&](const Vector3& x) {
      const GroupPose pose = with_x(axis.pose, x);
      starts.emplace_back(fit_.support(pose, element, rough_tolerance), pose);
    };
    for (const Direction& plane : planes_)
      if (std::abs(plane.z().dot(axis.z())) < same_direction) {
        add(plane.z());
        add(plane.z().cross(axis.z()));
      }
    for (int step = 0; step < (axis.order == 0 ? 1 : steps); ++step)
      add(turn(axis.z(), period * step / steps) * Vector3(axis.pose.axes.col(0)));
    std::stable_sort(starts.begin(), starts.end(),
                     [](const auto& a, const auto& b) { return a.first > b.first; });
    constexpr std::size_t most = 4;
    if (starts.size() > most) starts.resize(most);
    for (const auto& [support, start] : starts) {
      // With the turns, which hold the axis where it is.
      std::vector<Matrix3> elements{element};
      if (axis.order > 1) elements.push_back(turned(1.0 / static_cast<double>(axis.order)));
      const std::optional<Direction> found = tried(start, elements);
      if (found && is_symmetry(found->score)) return found->pose;
    }
    return {};
  }

  // A few elements that tell the pose, of a group that may have a hundred.
  static std::vector<Matrix3> spread(const std::vector<Matrix3>& elements) {
    constexpr std::size_t most = 12;
    std::vector<Matrix3> chosen;
    const std::size_t step = (elements.size() + most - 1) / most;
    for (std::size_t k = 1; k < elements.size(); k += step) chosen.push_back(elements[k]);
    return chosen;
  }

  std::optional<Symmetries> verified(const Placed& placed) const {
    std::vector<Matrix3> elements = placed.group.elements;
    if (placed.group.continuous || placed.group.all)
      for (const Matrix3& any : any_turns()) elements.push_back(any);
    constexpr std::size_t in_all = 4 * samples;
    const GroupPose pose = fit_.closely(placed.pose, spread(elements), in_all);
    double least = 1;
    for (const Matrix3& element : elements) {
      if (element.isIdentity()) continue;
      least = std::min(least, orbit_vote(score_, pose, {element}).share());
      // A product may leave a little more out than its factors do.
      if (!is_symmetry(least + below_best / 2)) return {};
    }
    return described({placed.group, pose}, least);
  }

  Symmetries described(const Placed& placed, double score) const {
    const PrincipalFrame& frame = cloud_.frame;
    const auto to_input = [&](const Vector3& direction) -> Vector3 {
      return frame.axes * (placed.pose.axes * direction);
    };
    Symmetries found;
    found.group = placed.group.name;
    found.centre = frame.from_frame(placed.pose.centre);
    for (const Vector3& normal : placed.group.plane_normals()) {
      const Vector3 unit = placed.pose.axes * normal;
      found.planes.push_back(in_input_units({unit, -unit.dot(placed.pose.centre)}, frame));
    }
    for (const PointGroup::Axis& axis : placed.group.axes())
      found.axes.push_back({found.centre, to_input(axis.direction), axis.order});
    found.inversion = placed.group.inversion();
    for (const Matrix3& element : placed.group.elements) {
      const Matrix3 axes = frame.axes * placed.pose.axes;
      Matrix4 matrix = Matrix4::Identity();
      matrix.topLeftCorner<3, 3>() = axes * element * axes.transpose();
      matrix.topRightCorner<3, 1>() = found.centre - matrix.topLeftCorner<3, 3>() * found.centre;
      found.elements.push_back(matrix);
    }
    found.score = score;
    return found;
  }

  const Cloud& cloud_;
  const Context& context_;
  double minimum_score_;
  PointTree tree_;
  NearestPoints points_;
  Surfels coarse_, fine_;
  MirrorScore score_;
  SymmetryFit fit_;
  std::vector<Direction> planes_, axes_;
  Vector3 centre_ = Vector3::Zero();
  double best_ = 0;  // score
};

}  // namespace

Symmetries search_symmetries(const Cloud& cloud, double minimum_score, const Context& context) {
  return SymmetrySearch(cloud, minimum_score, context).run();
}

}  // namespace symsurf
