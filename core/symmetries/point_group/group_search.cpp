#include "point_group/group_search.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <span>

#include "base/linear_algebra.h"
#include "base/math.h"
#include "base/random.h"
#include "cloud/exact_isometries.h"
#include "fit/fitted.h"

namespace symsurf {

namespace {

constexpr double widest = 0.125;  // diameters: of what pose benchmarks take for a symmetry
constexpr double exactly = 1e-5;  // diameters
constexpr Index highest_order = 64;
constexpr double pi = std::numbers::pi;

Matrix3 cross_matrix(const Vector3& v) {
  Matrix3 m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

// An element of a point group as it stands in a pose, whose small turn and shift a fit looks for.
struct PosedElement {
  using Change = Eigen::Vector<double, 6>;
  // Directions that the elements leave free, as along an axis, stay as they are.
  static constexpr double ridge = 1e-6;

  GroupPose pose;
  Matrix3 element;
  Eigen::Isometry3d map = pose.placed(element);

  Eigen::Matrix<double, 3, 6> slopes(const Vector3& x) const {
    const Matrix3& turn = map.linear();
    Eigen::Matrix<double, 3, 6> slopes;
    slopes << turn * cross_matrix(x - pose.centre) - cross_matrix(map * x - pose.centre),
        Matrix3::Identity() - turn;
    return slopes;
  }

  std::pair<PosedElement, double> stepped(const Change& by) const {
    constexpr double longest = 0.15;  // radians, diagonals: what is longer is no small turn
    const double length = by.norm();
    const Change cut = length > longest ? Change(longest / length * by) : by;
    GroupPose next = pose;
    if (const double angle = cut.head<3>().norm(); angle > 0)
      next.axes = Eigen::AngleAxisd(angle, cut.head<3>() / angle).toRotationMatrix() * pose.axes;
    next.centre += cut.tail<3>();
    return {{next, element}, length};
  }
};

// At random: of every so many, as in a coset, some would never be seen.
std::vector<Matrix3> some_of(std::vector<Matrix3> elements, std::size_t most) {
  std::erase_if(elements, [](const Matrix3& each) { return each.isIdentity(1e-9); });
  Random random(7);
  for (std::size_t k = 0; k < std::min(most, elements.size()); ++k)
    std::swap(elements[k], elements[k + random.below(static_cast<Index>(elements.size() - k))]);
  if (elements.size() > most) elements.resize(most);
  return elements;
}

std::vector<Matrix3> with_turns(const PointGroup& group) {
  constexpr int turns = 10;
  std::vector<Matrix3> elements = group.elements;
  for (const PointGroup::Axis& axis : group.axes())
    if (axis.order == 0)
      for (const Matrix3& turned : any_turns(axis.direction, turns))
        for (const Matrix3& element : group.elements) elements.push_back(turned * element);
  return elements;
}

// How a pose is fitted: by robust weights whose scale shrinks from a length on, or to the greatest
// distances.
struct PoseFit {
  int steps;
  double scale;
  bool to_greatest = false;
};

// One pose for all elements, by Gauss-Newton steps on the distances of all images.
template <typename Distance>
GroupPose fitted(GroupPose pose, const std::vector<Matrix3>& elements,
                 std::span<const Vector3> points, const Distance& distance, const PoseFit& fit) {
  constexpr double narrowing = 0.68, reach = 2.5, still = 1e-8;
  double scale = fit.scale;
  std::vector<double> distances;
  struct Image {
    const PosedElement& element;
    const Vector3& x;
    Offset offset;
  };
  std::vector<Image> images;
  for (int step = 0; step < fit.steps; ++step, scale *= narrowing) {
    std::vector<PosedElement> posed;
    for (const Matrix3& element : elements) posed.push_back({pose, element});
    images.clear();
    distances.clear();
    for (const PosedElement& element : posed)
      for (const Vector3& x : points) {
        const Offset offset = distance(element.map * x);
        if (offset.missing) continue;
        images.push_back({element, x, offset});
        distances.push_back(offset.distance);
      }
    if (images.empty()) return pose;
    const double greatest = *std::max_element(distances.begin(), distances.end());
    const double width = std::max(std::min(scale, reach * quantile(distances, 0.85)), exactly);
    GaussNewton<PosedElement> sum;
    for (const auto& [element, x, offset] : images) {
      const double relative = offset.distance / (fit.to_greatest ? greatest + 1e-12 : width);
      const double squared = relative * relative;
      const double weight =
          fit.to_greatest ? squared * squared : 1 / ((1 + squared) * (1 + squared));
      sum.add(element, x, offset.distance * offset.direction.normalized(),
              {0, offset.direction.squaredNorm(), offset.direction.normalized()}, weight);
    }
    const auto [next, change] = sum.taken(posed.front());
    pose = next.pose;
    if (change < still) break;
  }
  return pose;
}

}  // namespace

Eigen::Isometry3d GroupPose::placed(const Matrix3& element) const {
  return map_taking(axes * element * axes.transpose(), centre, centre);
}

GroupPose GroupPose::along(const Vector3& z, const Vector3& centre) {
  GroupPose pose;
  pose.axes << orthogonal_to(z), z;
  if (pose.axes.determinant() < 0) pose.axes.col(0) *= -1;
  pose.centre = centre;
  return pose;
}

double HeldGroup::size() const {
  constexpr double continuous = 1e4, all = 1e9;
  return static_cast<double>(group.elements.size()) * (group.all          ? all
                                                       : group.continuous ? continuous
                                                                          : 1);
}

std::vector<Eigen::Isometry3d> HeldGroup::maps() const {
  std::vector<Eigen::Isometry3d> placed;
  for (const Matrix3& element : with_turns(group))
    if (!element.isIdentity(0)) placed.push_back(pose.placed(element));
  return placed;
}

bool HeldGroup::holds(const HeldGroup& other) const {
  constexpr double same = 0.15;  // between matrices
  if (group.all) return true;
  if (other.group.all || (other.group.continuous && !group.continuous)) return false;
  const Matrix3 into = pose.axes.transpose() * other.pose.axes;
  if (other.group.continuous && std::abs(into(2, 2)) < 1 - same * same / 2) return false;
  return std::all_of(
      other.group.elements.begin(), other.group.elements.end(), [&](const Matrix3& element) {
        const Matrix3 here = into * element * into.transpose();
        return std::any_of(group.elements.begin(), group.elements.end(), [&](const Matrix3& own) {
          const Matrix3 left = own.transpose() * here;
          return group.continuous
                     ? left.determinant() > 0 && (left.col(2) - Vector3::UnitZ()).norm() < same
                     : (left - Matrix3::Identity()).norm() < 2 * same;
        });
      });
}

namespace {

class GroupSearch {
 public:
  GroupSearch(const SurfaceDistance& surface, HeldGroup exact, const Context& context)
      : surface_(surface),
        exact_(std::move(exact)),
        context_(context),
        limit_(widest * surface.diameter()),
        grid_error_(0.012 * surface.diameter()),
        probes_(surface.samples().begin(),
                surface.samples().begin() +
                    std::min<std::ptrdiff_t>(
                        150, static_cast<std::ptrdiff_t>(surface.samples().size()))) {}

  std::vector<HeldGroup> run() {
    find_lines();
    polyhedral();
    guess(spherical_group(), {});
    guess(inversion_group(), {});
    for (const GroupPose& mirror : mirrors_) guess(reflection_group(), mirror);
    for (const GroupPose& line : lines_) {
      context_.check();
      about(line);
    }
    context_.report(0.6);
    measure();
    return std::move(found_);
  }

 private:
  struct Guess {
    HeldGroup held;
    double quantile, greatest;  // rough
  };

  double mean_off(const Eigen::Isometry3d& map, std::size_t stride = 1) const {
    double sum = 0;
    for (std::size_t k = 0; k < probes_.size(); k += stride)
      sum += surface_.rough(map * probes_[k]).distance;
    return sum / static_cast<double>((probes_.size() + stride - 1) / stride);
  }

  double mean_off(const GroupPose& pose, const std::vector<Matrix3>& elements) const {
    double greatest = 0;
    for (const Matrix3& element : elements)
      greatest = std::max(greatest, mean_off(pose.placed(element)));
    return greatest;
  }

  GroupPose roughly(const GroupPose& pose, const std::vector<Matrix3>& elements,
                    int steps = 10) const {
    return fitted(
        pose, elements, std::span(probes_).first(std::min<std::size_t>(100, probes_.size())),
        [&](const Vector3& x) { return surface_.rough(x); }, {steps, 0.1 * surface_.diameter()});
  }

  // Each mirror and turn is tried in many directions, the best few of each are fitted.
  void find_lines() {
    constexpr int directions = 1200;
    constexpr std::size_t most = 7, most_lines = 12;
    constexpr double apart = 0.16, same_tilt = 0.035, same_offset = 0.015;  // radians, diameters
    const double most_off = 0.06 * surface_.diameter();
    std::vector<Vector3> tried;
    for (int axis = 0; axis < 3; ++axis) tried.push_back(Vector3::Unit(axis));
    for (const PointGroup::Axis& axis : exact_.group.axes())
      tried.push_back(exact_.pose.axes * axis.direction);
    for (int k = 0; k < directions; ++k) {
      const double z = (k + 0.5) / directions, r = std::sqrt(1 - z * z),
                   angle = pi * (1 + std::sqrt(5.0)) * (k + 0.5);
      tried.emplace_back(r * std::cos(angle), r * std::sin(angle), z);
    }
    struct Found {
      double off;
      GroupPose pose;
      bool is_mirror;
    };
    std::vector<Found> found;
    const Vector3 z = Vector3::UnitZ();
    for (const int order : {1, 2, 3, 4, 5, 6, 0}) {
      context_.check();
      const std::vector<Matrix3> elements = order == 1   ? std::vector{reflection(z)}
                                            : order == 0 ? any_turns(z, 5)
                                                         : std::vector{turn(z, 2 * pi / order)};
      std::vector<std::pair<double, std::size_t>> ranked;
      for (std::size_t k = 0; k < tried.size(); ++k) {
        const GroupPose pose = GroupPose::along(tried[k], exact_.pose.centre);
        double off = 0;
        for (const Matrix3& element : elements) off = std::max(off, mean_off(pose.placed(element)));
        if (off < most_off) ranked.emplace_back(off, k);
      }
      std::sort(ranked.begin(), ranked.end());
      suppress_non_maxima(ranked, most, [&](const auto& a, const auto& b) {
        return are_parallel(tried[a.second], tried[b.second], apart);
      });
      for (const auto& [off, k] : ranked) {
        const GroupPose pose = roughly(GroupPose::along(tried[k], exact_.pose.centre), elements);
        found.push_back({mean_off(pose, elements), pose, order == 1});
      }
    }
    std::stable_sort(found.begin(), found.end(),
                     [](const Found& a, const Found& b) { return a.off < b.off; });
    for (const Found& each : found) {
      if (each.is_mirror) mirrors_.push_back(each.pose);
      const bool is_new = std::none_of(lines_.begin(), lines_.end(), [&](const GroupPose& line) {
        const Vector3 d = line.axes.col(2), gap = line.centre - each.pose.centre;
        return are_parallel(d, each.pose.axes.col(2), same_tilt) &&
               (each.is_mirror ||
                (gap - gap.dot(d) * d).norm() < same_offset * surface_.diameter());
      });
      if (is_new && lines_.size() < most_lines) lines_.push_back(each.pose);
    }
    // Where there is a set of exact axes they are among the lines as they are.
    for (const PointGroup::Axis& axis : exact_.group.axes())
      if (axis.order > 2 || exact_.group.axes().size() == 1)
        lines_.insert(lines_.begin(),
                      GroupPose::along(exact_.pose.axes * axis.direction, exact_.pose.centre));
  }

  // Groups with several axes of order 3 or more: turned at random.
  void polyhedral() {
    constexpr int poses = 3000;
    constexpr std::size_t most = 16, most_guessed = 3, looked = 6;
    constexpr double roundest = 0.6;  // of the variances
    Points rows = rows_of(probes_);
    rows.rowwise() -= rows.colwise().mean().eval();
    const SymmetricEigen<3> scatter = eigen_of_scatter(rows);
    if (scatter.values[0] < roundest * scatter.values[2]) return;
    for (const Index order : {5, 4, 3}) {
      context_.check();
      const PointGroup turns = polyhedral_group(order, false, false);
      const std::vector<Matrix3> some = some_of(turns.elements, looked);
      std::vector<std::pair<double, GroupPose>> starts;
      Random random(3);
      for (int k = 0; k < poses; ++k) {
        GroupPose pose{Matrix3::Identity(), exact_.pose.centre};
        if (k > 0) pose.axes = basis_of(random.direction(), random.direction());
        double off = 0;
        for (const Matrix3& element : some) off = std::max(off, mean_off(pose.placed(element), 2));
        starts.emplace_back(off, pose);
      }
      const auto sort_best = [&] {
        std::stable_sort(starts.begin(), starts.end(),
                         [](const auto& a, const auto& b) { return a.first < b.first; });
      };
      sort_best();
      starts.resize(most);
      const std::vector<Matrix3> more = some_of(turns.elements, 2 * looked);
      for (auto& [off, pose] : starts) {
        pose = roughly(pose, more);
        off = mean_off(pose, more);
      }
      sort_best();
      for (std::size_t k = 0; k < most_guessed; ++k) {
        const GroupPose& pose = starts[k].second;
        guess(polyhedral_group(order, true, true), pose);
        if (order == 3) guess(polyhedral_group(3, false, true), pose);
        guess(turns, pose);
      }
    }
  }

  // What there may be about an axis.
  void about(const GroupPose& line) {
    const GroupPose round = roughly(line, any_turns(Vector3::UnitZ(), 8));
    families(round, 0);
    for (const Index order : orders(line)) families(line, order);
  }

  // Of turns that all of the shape may have, by how far those by any angle take it off itself.
  std::vector<Index> orders(const GroupPose& line) const {
    constexpr int angles = 720;
    constexpr Index always = 6;
    std::vector<double> off(angles);
    for (int k = 0; k <= angles / 2; ++k)
      off[k] = off[(angles - k) % angles] =
          mean_off(line.placed(turn(Vector3::UnitZ(), 2 * pi * k / angles)));
    // At the identity points meet themselves.
    const std::vector<double> others(off.begin() + 4, off.end() - 3);
    const double middle = median(others), least = symsurf::quantile(others, 0.01);
    std::vector<Index> found;
    for (Index order = highest_order; order >= 2; --order) {
      double worst = 0;
      for (Index k = 1; k < order; ++k)
        worst = std::max(worst, off[(k * angles + order / 2) / order % angles]);
      const bool is_dip = worst < least + 0.6 * (middle - least);
      if (worst < 0.07 * surface_.diameter() && (order <= always || is_dip)) found.push_back(order);
    }
    return found;
  }

  void families(const GroupPose& line, Index order) {
    const double most_off = 0.07 * surface_.diameter();
    const Matrix3 across = reflection(Vector3::UnitZ()), vertical = reflection(Vector3::UnitX()),
                  twofold = turn(Vector3::UnitX(), pi);
    const double n = static_cast<double>(std::max<Index>(order, 1));
    const auto turned = [&](double angle) {
      GroupPose pose = line;
      pose.axes = line.axes * turn(Vector3::UnitZ(), angle);
      return pose;
    };
    // The best angles of an element along x.
    const auto angles = [&](const Matrix3& element) {
      constexpr std::size_t most = 2;
      std::vector<std::pair<double, double>> found;
      const double period = pi / n, step = order == 0 ? period : std::min(0.03, period / 8);
      for (double angle = 0; angle < period - step / 2; angle += step)
        found.emplace_back(mean_off(turned(angle).placed(element)), angle);
      std::sort(found.begin(), found.end());
      suppress_non_maxima(found, order == 0 ? 1 : most, [&](const auto& a, const auto& b) {
        const double apart = std::abs(a.second - b.second);
        return std::min(apart, period - apart) < 3 * step;
      });
      std::erase_if(found, [&](const auto& each) { return each.first > most_off; });
      return found;
    };
    const auto mirrors = angles(vertical), half_turns = angles(twofold);
    for (const auto& [off, angle] : mirrors) {
      guess(axial_group(order, {.across = true, .vertical = true}), turned(angle));
      if (order > 1) guess(axial_group(order, {.rotary = true, .vertical = true}), turned(angle));
      if (order != 1) guess(axial_group(order, {.vertical = true}), turned(angle));
    }
    if (order == 0) {
      if (mirrors.empty()) guess(axial_group(0, {}), line);
      return;
    }
    for (const auto& [off, angle] : half_turns)
      guess(axial_group(order, {.twofold = true}), turned(angle));
    if (mean_off(line.placed(across)) < most_off) guess(axial_group(order, {.across = true}), line);
    if (mean_off(line.placed(turn(Vector3::UnitZ(), pi / n) * across)) < most_off)
      guess(axial_group(order, {.rotary = true}), line);
    guess(axial_group(order, {}), line);
  }

  void guess(const PointGroup& group, const GroupPose& start) {
    constexpr std::size_t fitted = 8, looked = 20;
    const std::vector<Matrix3> all = with_turns(group);
    Guess made{{group, roughly(start, some_of(all, fitted), 8), {}}, 0, 0};
    if (!made.held.holds(exact_)) return;
    std::vector<double> distances;
    for (const Matrix3& element : some_of(all, looked)) {
      const Eigen::Isometry3d map = made.held.pose.placed(element);
      distances.clear();
      for (const Vector3& x : probes_) distances.push_back(surface_.rough(map * x).distance);
      made.quantile =
          std::max(made.quantile, symsurf::quantile(distances, surface_.is_mesh() ? 0.95 : 0.85));
      made.greatest =
          std::max(made.greatest, *std::max_element(distances.begin(), distances.end()));
    }
    if (made.quantile < 0.5 * limit_ + grid_error_) guesses_.push_back(std::move(made));
  }

  // The best guesses first, the largest of those that are as good, but for those that cannot be
  // better than a larger one.
  void measure() {
    constexpr std::size_t most = 60;
    constexpr Index quickly = 6000;  // images
    std::stable_sort(guesses_.begin(), guesses_.end(), [&](const Guess& a, const Guess& b) {
      const auto rank = [&](const Guess& each) {
        return std::floor((each.quantile + 0.2 * each.greatest) / grid_error_);
      };
      return std::pair(rank(a), -a.held.size()) < std::pair(rank(b), -b.held.size());
    });
    found_.push_back(exact_);
    const double floor = std::max(surface_.rounding() / 4, exactly * surface_.diameter());
    std::size_t measured = 0;
    for (Guess& each : guesses_) {
      context_.check();
      HeldGroup& held = each.held;
      if (held.size() <= exact_.size() || measured == most) continue;
      const auto is_no_better = [&](const HeldGroup& other) {
        return other.size() >= held.size() &&
               other.deviation.greatest <= std::max(floor, each.greatest - 2 * grid_error_) &&
               other.deviation.quantile <= std::max(floor, each.quantile - grid_error_);
      };
      const auto is_known = [&](const HeldGroup& other) {
        return other.group.name == held.group.name && other.holds(held) &&
               other.deviation.quantile < each.quantile + grid_error_ &&
               (other.pose.centre - held.pose.centre).norm() < grid_error_;
      };
      if (std::any_of(found_.begin(), found_.end(), is_no_better) ||
          std::any_of(found_.begin(), found_.end(), is_known))
        continue;
      ++measured;
      constexpr std::size_t elements = 8, images = 900;
      const std::vector<Matrix3> some = some_of(with_turns(held.group), elements);
      const auto points = std::span(surface_.samples())
                              .first(std::min(surface_.samples().size(), images / some.size()));
      const auto distance = [&](const Vector3& x) { return surface_(x); };
      held.pose = fitted(held.pose, some, points, distance, {8, 0.04 * surface_.diameter()});
      held.deviation = surface_.deviation(held.maps(), quickly);
      found_.push_back(held);
      if (surface_.is_mesh() && held.deviation.greatest > floor) {
        held.pose = fitted(held.pose, some, points, distance, {6, 0, true});
        held.deviation = surface_.deviation(held.maps(), quickly);
        if (held.deviation.greatest < found_.back().deviation.greatest) found_.push_back(held);
      }
    }
  }

  const SurfaceDistance& surface_;
  HeldGroup exact_;
  const Context& context_;
  double limit_, grid_error_;
  std::vector<Vector3> probes_;
  std::vector<GroupPose> lines_, mirrors_;
  std::vector<Guess> guesses_;
  std::vector<HeldGroup> found_;
};

// The group whose elements are nearest to these, which nearly make one: each becomes the mean of
// what products say of it (Grove, Karcher and Ruh 1974). None where a product is missing.
std::optional<std::vector<Matrix3>> made_exact(std::vector<Matrix3> elements) {
  constexpr int rounds = 5;
  constexpr double same = 0.1;
  const std::size_t count = elements.size();
  std::vector<std::size_t> products(count * count);
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t j = 0; j < count; ++j) {
      const Matrix3 product = elements[i] * elements[j];
      const auto found = std::find_if(elements.begin(), elements.end(), [&](const Matrix3& each) {
        return (each - product).norm() < same;
      });
      if (found == elements.end()) return {};
      products[i * count + j] = found - elements.begin();
    }
  for (int round = 0; round < rounds; ++round) {
    std::vector<Matrix3> next(count, Matrix3::Zero());
    for (std::size_t i = 0; i < count; ++i) {
      for (std::size_t j = 0; j < count; ++j)
        next[i] += elements[products[i * count + j]] * elements[j].transpose();
      next[i] = nearest_orthogonal(next[i], elements[i].determinant() > 0 ? 1 : -1);
    }
    elements = std::move(next);
  }
  elements.front().setIdentity();
  return elements;
}

// That of the isometries which map each vertex, or point, onto one to within a share of the
// diameter, as far as they map the surface.
HeldGroup isometry_group(const Cloud& shape, const PrincipalFrame& frame,
                         const SurfaceDistance& surface, double within, const Context& context) {
  constexpr Index checked = 2000;
  constexpr std::size_t most = 2000;
  constexpr Index images = 200;
  const ExactIsometries found =
      exact_isometries(shape.points, shape.tree(context), context, most, checked, within);
  HeldGroup held;
  held.pose.centre = frame.to_frame(found.centre);
  std::vector<Matrix3> elements{Matrix3::Identity()};
  for (const Matrix3& map : found.maps) {
    if (map.isIdentity(0)) continue;
    const Matrix3 element = frame.axes.transpose() * map * frame.axes;
    if (!surface.is_mesh() || surface.deviation({held.pose.placed(element)}, images).greatest <
                                  exactly * surface.diameter())
      elements.push_back(element);
  }
  if (const auto group = made_exact(std::move(elements))) held.group = PointGroup(*group);
  return held;
}

}  // namespace

std::vector<HeldGroup> possible_groups(const Cloud& shape, const PrincipalFrame& frame,
                                       const SurfaceDistance& surface, double tolerance,
                                       const Context& context) {
  HeldGroup exact;
  if (surface.is_mesh() || surface.is_set())
    exact = isometry_group(shape, frame, surface, exactly, context.stage(0, 0.2));
  if (!surface.is_set()) return GroupSearch(surface, std::move(exact), context.stage(0.2, 1)).run();
  std::vector<HeldGroup> found{std::move(exact)};
  // Wide tolerances may let in more than makes a group.
  for (double within = tolerance / surface.diameter(); within > exactly; within /= 2) {
    HeldGroup held = isometry_group(shape, frame, surface, within, context);
    if (held.size() <= found.front().size()) continue;
    found.push_back(std::move(held));
  }
  return found;
}

}  // namespace symsurf
