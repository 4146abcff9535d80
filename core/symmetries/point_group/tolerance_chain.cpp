#include "point_group/tolerance_chain.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>
#include <utility>

#include "base/linear_algebra.h"
#include "base/math.h"
#include "base/parallel.h"
#include "base/random.h"
#include "cloud/exact_isometries.h"

namespace symsurf {

namespace {

// Lengths are in diameters.
constexpr double widest_tolerance = 0.125;  // maximum: beyond it nothing is called symmetric
constexpr double as_good_as_exact = 1e-5;
constexpr double of_grid = 0.02;  // what a pose that is fitted on the grid adds to deviations
constexpr double gain = 0.9;      // of a deviation that is worth a smaller group
constexpr double likely = 0.07;   // mean distance of images, on the grid
constexpr Index tested_images = 60'000, glanced_images = 800;
constexpr Index finest_turn = 64;
constexpr std::size_t most_lines = 10;

// About `most` of them; a stride would see the elements of one coset alone.
std::vector<Matrix3> some_of(const std::vector<Matrix3>& elements, std::size_t most) {
  std::vector<Matrix3> chosen;
  const std::size_t count = elements.size() - 1;
  for (std::size_t k = 1; k <= std::min(most, count); ++k) {
    const double at = static_cast<double>(k) * std::numbers::phi;
    const auto i =
        count <= most
            ? k
            : 1 + static_cast<std::size_t>((at - std::floor(at)) * static_cast<double>(count));
    chosen.push_back(elements[i]);
  }
  return chosen;
}

bool is_on_line(const GroupPose& one, const GroupPose& other, double angle, double offset) {
  const Vector3 z = one.axes.col(2), apart = one.centre - other.centre;
  return are_parallel(z, other.axes.col(2), angle) && z.cross(apart).norm() < offset;
}

GroupPose turned_by(GroupPose pose, double angle) {
  pose.axes = pose.axes * turn(Vector3::UnitZ(), angle);
  return pose;
}

// Of each of the elements; looks at about so many images.
std::vector<ImageDeviation> deviations_of(const PointGroup& group, const GroupPose& pose,
                                          const SurfaceDistance& surface, Index looked,
                                          const Context& context) {
  const std::vector<Matrix3> elements = tested_elements(group);
  const auto count = static_cast<Index>(elements.size());
  constexpr Index grain = 4, least = 16;  // elements, images
  std::vector<ImageDeviation> each(elements.size());
  silent_parallel_for(context, count, grain, [&](Index begin, Index end) {
    for (Index e = begin; e < end; ++e)
      if (!elements[e].isIdentity())
        each[e] = surface.deviation(pose.placed(elements[e]), std::max(least, looked / count), e);
  });
  return each;
}

// The largest of all; of few images the mean quantile.
ImageDeviation glance(const PointGroup& group, const GroupPose& pose,
                      const SurfaceDistance& surface, const Context& context) {
  ImageDeviation all;
  double sum = 0, count = 0;
  for (const ImageDeviation& one : deviations_of(group, pose, surface, glanced_images, context)) {
    all.merge(one);
    sum += one.quantile;
    count += one.maximum > 0;
  }
  constexpr double most_missing = 0.35;  // share: of a shape of which more is there than is not
  all.quantile = all.missing > most_missing ? infinity : sum / std::max(count, 1.0);
  if (all.missing > most_missing) all.maximum = infinity;
  return all;
}

}  // namespace

bool is_within(const MeasuredGroup& one, const MeasuredGroup& other) {
  constexpr double most_apart = 0.15;  // radians
  if (one.group.elements.size() == 1 && !one.is_continuous()) return true;
  if (other.group.all) return true;
  if (one.group.all) return false;
  const Vector3 z = other.pose.axes.col(2);
  const auto map = [](const MeasuredGroup& of, const Matrix3& element) {
    return Matrix3(of.pose.axes * element * of.pose.axes.transpose());
  };
  if (other.group.continuous) {
    if (one.group.continuous && !are_parallel(z, one.pose.axes.col(2), most_apart)) return false;
    return std::all_of(one.group.elements.begin(), one.group.elements.end(),
                       [&](const Matrix3& element) {
                         const Matrix3 own = map(one, element);
                         const double along = z.dot(own * z);
                         return std::abs(along) > std::cos(most_apart) &&
                                std::any_of(other.group.elements.begin(),
                                            other.group.elements.end(), [&](const Matrix3& kind) {
                                              return kind.determinant() * own.determinant() > 0 &&
                                                     kind(2, 2) * along > 0;
                                            });
                       });
  }
  if (one.group.continuous || other.group.elements.size() % one.group.elements.size() != 0)
    return false;
  const auto order = static_cast<double>(
      std::max<Index>(2, other.group.axes().empty() ? 2 : other.group.axes().front().order));
  const double apart = std::sqrt(2) * std::min(most_apart, std::numbers::pi / (3 * order));
  return std::all_of(
      one.group.elements.begin(), one.group.elements.end(), [&](const Matrix3& element) {
        const Matrix3 own = map(one, element);
        return std::any_of(
            other.group.elements.begin(), other.group.elements.end(),
            [&](const Matrix3& each) { return (map(other, each) - own).norm() < apart; });
      });
}

double MeasuredGroup::size() const {
  constexpr double continuous = 1e4;
  const auto count = static_cast<double>(group.elements.size());
  return group.all ? continuous * continuous : group.continuous ? continuous * count : count;
}

void measure(MeasuredGroup& own, const SurfaceDistance& surface, const Context& context) {
  own.each = deviations_of(own.group, own.pose, surface, tested_images, context);
  own.deviation = {};
  for (const ImageDeviation& one : own.each) own.deviation.merge(one);
}

TolerancedGroups::TolerancedGroups(const SurfaceDistance& surface, const Context& context)
    : surface_(surface), context_(context) {
  found_.push_back({{}, true});
  search();
}

// Gauss-Newton steps on the distances of all images, with a robust width that shrinks to the
// residuals; or with their sixth power, which comes near the least maximum.
GroupPose TolerancedGroups::fitted(GroupPose pose, const std::vector<Matrix3>& elements,
                                   const Fitting& fitting) const {
  constexpr std::size_t most_elements = 8, most_images = 900;
  constexpr double widest = 0.1, narrower = 0.68, narrowest = 1e-5, inliers = 0.85,
                   deviations = 2.5;
  constexpr double power = 4, damped = 0.6, still = 1e-7;
  const std::vector<Matrix3> some = some_of(elements, most_elements);
  std::vector<Vector3> points = surface_.samples();
  if (fitting.to_maximum)
    points.insert(points.end(), surface_.ends().begin(), surface_.ends().end());
  const std::size_t stride = 1 + points.size() * some.size() / most_images;
  struct Row {
    double distance;
    PosedElement::Change slope;
  };
  double width = widest;
  for (int step = 0; step < fitting.steps; ++step) {
    context_.check();
    std::vector<Row> rows;
    std::vector<double> distances;
    for (std::size_t e = 0; e < some.size(); ++e) {
      const PosedElement posed(pose, some[e]);
      std::vector<Vector3> chosen, images;
      for (std::size_t i = e % stride; i < points.size(); i += stride) {
        chosen.push_back(points[i]);
        images.push_back(posed.reflect(points[i]));
      }
      std::vector<SurfaceDistance::Foot> feet;
      if (fitting.is_rough)
        for (const Vector3& image : images) feet.push_back(surface_.rough_foot(image));
      else
        feet = surface_.feet(images);
      for (std::size_t i = 0; i < feet.size(); ++i) {
        if (feet[i].is_beyond_rim) continue;
        rows.push_back({feet[i].distance, posed.slopes(chosen[i]).transpose() * feet[i].gradient});
        distances.push_back(feet[i].distance);
      }
    }
    if (rows.empty()) return pose;
    const double most = std::max(*std::max_element(distances.begin(), distances.end()), narrowest);
    const double scale =
        std::max(narrowest, std::min(width, deviations * quantile(distances, inliers)));
    Eigen::Matrix<double, 6, 6> normal = Eigen::Matrix<double, 6, 6>::Zero();
    PosedElement::Change right = PosedElement::Change::Zero();
    for (const auto& [distance, slope] : rows) {
      const double in_scale = distance / scale;
      const double weight = fitting.to_maximum
                                ? std::pow(distance / most, power)
                                : 1 / ((1 + in_scale * in_scale) * (1 + in_scale * in_scale));
      normal += weight * slope * slope.transpose();
      right -= weight * distance * slope;
    }
    normal.diagonal().array() += PosedElement::ridge * 1e-2 * normal.trace() + 1e-15;
    PosedElement::Change change = solved<6>(normal, right);
    if (fitting.to_maximum) change *= damped;
    const auto [moved, length] = PosedElement(pose, some.front()).stepped(change);
    pose = moved.pose();
    if (length < still) break;
    width *= narrower;
  }
  return pose;
}

double TolerancedGroups::rough_mean(const GroupPose& pose,
                                    const std::vector<Matrix3>& elements) const {
  double worst = 0;
  const std::vector<Vector3>& points = surface_.samples();
  const std::size_t stride = 1 + points.size() / 100;
  for (const Matrix3& element : elements) {
    const Eigen::Isometry3d map = pose.placed(element);
    double sum = 0, count = 0;
    for (std::size_t i = 0; i < points.size(); i += stride, ++count)
      sum += surface_.rough_foot(map * points[i]).distance;
    worst = std::max(worst, sum / count);
  }
  return worst;
}

// Whether as large a group deviates hardly more, by both measures.
bool TolerancedGroups::is_dominated(const ImageDeviation& deviation, double size) const {
  ImageDeviation least{widest_tolerance, widest_tolerance, 0};
  for (const Held& held : found_)
    if (held.size() >= size) {
      least.maximum = std::min(least.maximum, held.deviation.maximum);
      least.quantile = std::min(least.quantile, held.deviation.quantile);
    }
  return gain * deviation.maximum + as_good_as_exact >= least.maximum &&
         gain * deviation.quantile + as_good_as_exact >= least.quantile;
}

// Where it is worse than others it is none; a pose that is fitted on the grid alone.
std::optional<MeasuredGroup> TolerancedGroups::tried(const PointGroup& group,
                                                     const GroupPose& start) {
  constexpr int rough_steps = 10, steps = 5;
  const std::vector<Matrix3> elements = tested_elements(group);
  MeasuredGroup found{group, fitted(start, elements, {rough_steps, true, false}), {}, {}};
  if (rough_mean(found.pose, some_of(elements, 16)) > likely) return {};
  const auto worse_by = [&](double fit) {
    found.deviation = glance(group, found.pose, surface_, context_);
    ImageDeviation least = found.deviation;
    least.maximum -= fit;
    least.quantile -= fit;
    return is_dominated(least, found.size());
  };
  if (worse_by(of_grid)) return {};
  found.pose = fitted(found.pose, elements, {steps, false, false});
  if (!worse_by(0)) found_.push_back({found, false});
  return found;
}

// In the pose with the least maximum where that is asked for.
void TolerancedGroups::measure_in_full(Held& held, bool by_quantile) const {
  if (held.is_measured) return;
  constexpr int steps = 8;
  held.is_measured = true;
  measure(held, surface_, context_);
  if (by_quantile || held.deviation.maximum < 10 * as_good_as_exact || held.size() == 1) return;
  MeasuredGroup other = held;
  other.pose = fitted(held.pose, tested_elements(held.group), {steps, false, true});
  measure(other, surface_, context_);
  if (other.deviation.maximum < held.deviation.maximum) static_cast<MeasuredGroup&>(held) = other;
}

// At each direction each element is tried on the grid; minima over the directions are fitted.
std::vector<GroupPose> TolerancedGroups::lines() {
  constexpr int directions = 600;
  constexpr double apart = 0.16;  // radians
  constexpr std::size_t most_minima = 6;
  std::vector<Vector3> all{Vector3::UnitX(), Vector3::UnitY(), Vector3::UnitZ()};
  for (const Vector3& direction : even_directions(directions)) all.push_back(direction);
  std::vector<std::vector<Matrix3>> kinds{{reflection(Vector3::UnitZ())},
                                          any_turns(Vector3::UnitZ(), 5)};
  for (Index order = 2; order <= 6; ++order) kinds.push_back(turns_of(order, 1));
  using Start = std::pair<double, GroupPose>;
  std::vector<std::vector<Start>> starts(kinds.size());
  silent_parallel_for(context_, static_cast<Index>(kinds.size()), 1, [&](Index begin, Index end) {
    for (Index k = begin; k < end; ++k) {
      for (const Vector3& direction : all) {
        const GroupPose pose = GroupPose::along(direction, Vector3::Zero());
        const double mean = rough_mean(pose, kinds[k]);
        if (mean < likely) starts[k].emplace_back(mean, pose);
      }
      std::stable_sort(starts[k].begin(), starts[k].end(),
                       [](const Start& a, const Start& b) { return a.first < b.first; });
      suppress_non_maxima(starts[k], most_minima, [&](const Start& a, const Start& b) {
        return are_parallel(a.second.axes.col(2), b.second.axes.col(2), apart);
      });
      for (auto& [mean, pose] : starts[k]) {
        pose = fitted(pose, kinds[k], {10, true, false});
        mean = rough_mean(pose, kinds[k]);
      }
    }
  });
  for (const auto& [mean, pose] : starts.front()) tried(reflection_group(), pose);
  std::vector<Start> best;
  for (const std::vector<Start>& some : starts) best.insert(best.end(), some.begin(), some.end());
  std::stable_sort(best.begin(), best.end(),
                   [](const Start& a, const Start& b) { return a.first < b.first; });
  suppress_non_maxima(best, most_lines, [](const Start& a, const Start& b) {
    constexpr double tilt = 0.035, offset = 0.015;
    return is_on_line(a.second, b.second, tilt, offset);
  });
  std::vector<GroupPose> found;
  for (const auto& [mean, pose] : best) found.push_back(pose);
  return found;
}

void TolerancedGroups::add_polyhedral() {
  constexpr int rotations = 1000;
  constexpr std::size_t most = 4;
  constexpr double least_ratio = 0.6;  // of variances
  const Vector3& variance = surface_.frame().variance;
  if (variance.minCoeff() < least_ratio * variance.maxCoeff()) return;
  tried(spherical_group(), {});
  Random random(0);
  std::vector<GroupPose> poses{{}};
  while (poses.size() < rotations) {
    GroupPose pose;
    pose.axes = basis_of(random.direction(), random.direction());
    poses.push_back(pose);
  }
  for (const Index order : {5, 4, 3}) {
    const PointGroup turns = polyhedral_group(order, false, false);
    const std::vector<Matrix3> some = some_of(turns.elements, 6);
    std::vector<std::pair<double, GroupPose>> starts;
    for (const GroupPose& pose : poses)
      if (const double mean = rough_mean(pose, some); mean < likely)
        starts.emplace_back(mean, pose);
    std::stable_sort(starts.begin(), starts.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    starts.resize(std::min(starts.size(), most));
    for (const auto& [mean, pose] : starts) {
      const auto found = tried(turns, pose);
      if (!found) continue;
      tried(polyhedral_group(order, true, false), found->pose);
      if (order == 3) tried(polyhedral_group(3, false, true), found->pose);
    }
  }
}

// What an axis has beside its turns: the angle of mirrors and half turns along it is scanned for.
void TolerancedGroups::add_about(Index order, const GroupPose& axis) {
  const auto n = static_cast<double>(std::max<Index>(order, 1));
  const Matrix3 across = reflection(Vector3::UnitZ());
  const double period = order == 0 ? 1e-9 : std::numbers::pi / n;
  const double step = std::min(0.05, period / 3);
  constexpr Index fine_from = 8;  // order: from here on the grid does not tell
  const auto mean = [&](const GroupPose& pose, const Matrix3& element) {
    if (order < fine_from) return rough_mean(pose, {element});
    std::vector<Vector3> images;
    const std::size_t stride = 1 + surface_.samples().size() / 60;
    for (std::size_t i = 0; i < surface_.samples().size(); i += stride)
      images.push_back(pose.placed(element) * surface_.samples()[i]);
    double sum = 0;
    for (const SurfaceDistance::Foot& foot : surface_.feet(images)) sum += foot.distance;
    return sum / static_cast<double>(images.size());
  };
  const auto scanned = [&](const Matrix3& element) {
    std::pair<double, GroupPose> best{infinity, axis};
    for (double angle = 0; angle < period; angle += step)
      if (const double own = mean(turned_by(axis, angle), element); own < best.first)
        best = {own, turned_by(axis, angle)};
    return best;
  };
  const auto [upright, at_mirror] = scanned(reflection(Vector3::UnitX()));
  const auto [twofold, at_twofold] = scanned(turn(Vector3::UnitX(), std::numbers::pi));
  const double flat = mean(axis, across);
  const double rotary =
      order == 0 ? infinity : mean(axis, turn(Vector3::UnitZ(), std::numbers::pi / n) * across);
  const auto all = {
      std::pair{std::max(flat, upright), AxialElements{.across = true, .vertical = true}},
      {std::max(rotary, upright), {.rotary = true, .vertical = true}},
      {twofold, {.twofold = true}},
      {upright, {.vertical = true}},
      {flat, {.across = true}},
      {rotary, {.rotary = true}},
      {0.0, {}}};
  for (const auto& [distance, has] : all)
    if (distance < likely)
      tried(axial_group(order, has), has.vertical ? at_mirror : has.twofold ? at_twofold : axis);
}

// Turns by 1/n: those first whose deviation, beside that of similar angles, dips the lowest.
void TolerancedGroups::add_turns(const std::vector<GroupPose>& axes) {
  constexpr double dips = 0.6, any = 0.03;
  constexpr std::size_t most = 16;
  constexpr Index always = 6;
  struct Job {
    double maximum, quantile;
    Index order;
    std::size_t axis;
  };
  std::vector<Job> jobs;
  for (std::size_t k = 0; k < axes.size(); ++k) {
    std::vector<ImageDeviation> curve(finest_turn + 1);
    silent_parallel_for(context_, finest_turn - 1, 8, [&](Index begin, Index end) {
      constexpr Index looked = 60;
      for (Index n = begin + 2; n < end + 2; ++n)
        curve[n] = surface_.deviation(axes[k].placed(turns_of(n, 1).front()), looked);
    });
    const auto is_dip = [&](Index n) {
      std::vector<double> maxima, quantiles;
      for (Index m = std::max<Index>(2, n / 2); m <= std::min(finest_turn, n + 12); ++m) {
        maxima.push_back(curve[m].maximum);
        quantiles.push_back(curve[m].quantile);
      }
      return curve[n].maximum < dips * median(maxima) ||
             curve[n].quantile < dips * median(quantiles);
    };
    for (Index n = 2; n <= finest_turn; ++n)
      if (dips * curve[n].maximum < widest_tolerance &&
          (n <= always || (curve[n].quantile < any && is_dip(n))))
        jobs.push_back({curve[n].maximum, curve[n].quantile, n, k});
  }
  std::stable_sort(jobs.begin(), jobs.end(), [](const Job& a, const Job& b) {
    const double rounded = std::round(1e3 * a.maximum) - std::round(1e3 * b.maximum);
    return rounded != 0 ? rounded < 0 : a.order > b.order;
  });
  std::vector<const Job*> done;
  for (const Job& job : jobs) {
    if (done.size() == most) break;
    const bool is_done = std::any_of(done.begin(), done.end(), [&](const Job* other) {
      constexpr double tilt = 0.01, offset = 0.004;
      return other->order == job.order &&
             is_on_line(axes[other->axis], axes[job.axis], tilt, offset);
    });
    // Of what it has four groups of as many turns may be made.
    const double most_elements = 4 * static_cast<double>(job.order);
    if (is_done || is_dominated({job.maximum - of_grid, job.quantile - of_grid, 0}, most_elements))
      continue;
    const auto turns = tried(axial_group(job.order, {}), axes[job.axis]);
    if (!turns || is_dominated(turns->deviation, most_elements)) continue;
    done.push_back(&job);
    add_about(job.order, turns->pose);
  }
}

void TolerancedGroups::search() {
  add_polyhedral();
  tried(inversion_group(), {});
  std::vector<GroupPose> axes;
  const std::vector<GroupPose> all = lines();
  for (const GroupPose& line : all) {
    const auto round = tried(axial_group(0, {.vertical = true}), line);
    if (round) {
      add_about(0, round->pose);
      axes.push_back(round->pose);
    }
  }
  axes.insert(axes.end(), all.begin(), all.end());
  suppress_non_maxima(axes, most_lines, [](const GroupPose& a, const GroupPose& b) {
    constexpr double tilt = 0.005, offset = 0.002;
    return is_on_line(a, b, tilt, offset);
  });
  add_turns(axes);
}

MeasuredGroup TolerancedGroups::largest(const Accepts& accepts, bool by_quantile) {
  constexpr double of_fit = 0.6;  // of the maximum, that is left by the pose for it
  std::stable_sort(found_.begin(), found_.end(),
                   [](const Held& a, const Held& b) { return a.size() > b.size(); });
  for (Held& held : found_) {
    MeasuredGroup hoped = held;
    if (!held.is_measured) hoped.deviation.maximum *= of_fit;
    if (!accepts(hoped)) continue;
    measure_in_full(held, by_quantile);
    if (accepts(held)) return held;
  }
  return found_.back();  // C1
}

std::vector<MeasuredGroup> TolerancedGroups::chain(const MeasuredGroup& through, bool by_quantile) {
  const auto of = [&](const MeasuredGroup& group) {
    return by_quantile ? group.deviation.quantile : group.deviation.maximum;
  };
  const auto precedes = [&](const MeasuredGroup& a, const MeasuredGroup& b) {
    const bool is_less = of(a) + as_good_as_exact <= gain * of(b) || a.size() == 1;
    return a.size() < b.size() && is_less && is_within(a, b);
  };
  std::vector<Held> pool{{through, true}};
  for (const Held& held : found_)
    if (of(held) < widest_tolerance && (precedes(held, through) || precedes(through, held)))
      pool.push_back(held);
  for (;;) {
    std::stable_sort(pool.begin(), pool.end(), [&](const Held& a, const Held& b) {
      return of(a) != of(b) ? of(a) < of(b) : a.size() < b.size();
    });
    // The logarithm of the number of elements, over that of the tolerance.
    const auto level = [&](double tolerance) { return std::log(std::max(tolerance, 1e-6)); };
    const double last = std::max(widest_tolerance, 2 * of(through));
    std::vector<double> worth(pool.size());
    std::vector<std::size_t> next(pool.size(), pool.size());
    for (std::size_t i = pool.size(); i-- > 0;) {
      const double elements = std::log(pool[i].size());
      worth[i] = elements * (level(last) - level(of(pool[i])));
      for (std::size_t j = i + 1; j < pool.size(); ++j) {
        const double other = elements * (level(of(pool[j])) - level(of(pool[i]))) + worth[j];
        if (other <= worth[i] || !precedes(pool[i], pool[j])) continue;
        worth[i] = other;
        next[i] = j;
      }
    }
    std::vector<MeasuredGroup> chain;
    bool is_measured = true;
    const auto first =
        std::find_if(pool.begin(), pool.end(), [](const Held& held) { return held.size() == 1; });
    for (std::size_t i = first - pool.begin(); i < pool.size(); i = next[i]) {
      is_measured = is_measured && pool[i].is_measured;
      measure_in_full(pool[i], by_quantile);
      chain.push_back(pool[i]);
    }
    if (is_measured) return chain;
  }
}

}  // namespace symsurf
