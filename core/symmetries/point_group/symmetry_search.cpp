#include "point_group/symmetry_search.h"

#include <symsurf/analyses.h>
#include <symsurf/context.h>
#include <symsurf/parameter.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "analysis.h"
#include "base/linear_algebra.h"
#include "base/math.h"
#include "base/parallel.h"
#include "cloud/closest_point_on_mesh.h"
#include "cloud/exact_isometries.h"
#include "cloud/triangle_mesh.h"
#include "detection/pipeline.h"
#include "point_group/point_group.h"

namespace symsurf {

namespace {

// Of the fit of the turns alone: a group that fits so much worse has more elements than the cloud.
constexpr double below_turns = 0.03;
// Of a part of a surface of revolution, of as much of the turn: as of continuous groups, and more
// the longer its rims are for what it has of surface.
constexpr double whole_turn = 0.95, most_outliers_of_whole = 0.04;

// Of a pose whose x is to point along a direction, which is laid across z.
GroupPose with_x(GroupPose pose, const Vector3& x) {
  const Vector3 z = pose.axes.col(2), across = (x - x.dot(z) * z).normalized();
  pose.axes << across, z.cross(across), z;
  return pose;
}

class SymmetrySearch {
 public:
  SymmetrySearch(const Cloud& cloud, double minimum_score, bool is_limited,
                 const std::function<bool(Symmetries&)>& accepts, const Context& context)
      : cloud_(cloud),
        accepts_(accepts),
        context_(context),
        test_(cloud, minimum_score, is_limited, context.stage(0, 0.4)) {}

  Symmetries run() {
    planes_ = find_planes(test_);
    context_.report(0.5);
    centre_ = centre_of(planes_);
    axes_ = find_axes(test_, planes_, centre_);
    context_.report(0.8);
    if (std::optional<Symmetries> found = partly_turned()) return *found;
    for (const auto& kind : {&SymmetrySearch::spherical, &SymmetrySearch::polyhedral,
                             &SymmetrySearch::axial, &SymmetrySearch::of_two})
      if (std::optional<Symmetries> found = (this->*kind)()) return *found;
    Symmetries none = described({}, {}, {.support = 1}, cloud_.frame);
    accepts_(none);
    return none;
  }

 private:
  struct Placed {
    PointGroup group;
    GroupPose pose;
    double expected = 0;  // fit: that of the turns alone
  };

  // Part of a surface of revolution, whose axis whole turns did not find.
  std::optional<Symmetries> partly_turned() const {
    const bool is_found = std::any_of(axes_.begin(), axes_.end(),
                                      [](const FoundDirection& axis) { return axis.order == 0; });
    if (is_found) return {};
    const std::optional<Revolution> part = find_revolution(cloud_, test_, context_.stage(0.8, 0.8));
    if (!part || part->turn > whole_turn ||
        part->axis.vote.outliers > most_outliers_of_whole / part->turn)
      return {};
    // Of a gear turns map the body, those by a tooth all of it.
    for (const FoundDirection& axis : axes_)
      if (axis.order > 2 && axis.vote.fit > part->axis.vote.fit + below_turns) return {};
    OrbitVote vote = part->axis.vote;
    vote.missing = 1 - part->turn;
    Symmetries found =
        described(axial_group(0, {.vertical = true}), part->axis.pose, vote, cloud_.frame);
    if (!accepts_(found)) return {};
    return found;
  }

  std::optional<Symmetries> spherical() const {
    if (axes_.empty() || axes_.front().order != 0) return {};
    const FoundDirection& axis = axes_.front();
    const GroupPose across = GroupPose::along(Vector3(axis.pose.axes.col(0)), axis.pose.centre);
    const auto other = test_.tried(across, any_turns(Vector3::UnitZ(), 4));
    if (!other) return {};
    return verified({spherical_group(), other->pose});
  }

  using Passed = std::optional<SymmetryTest::Passed>;

  // The largest that holds the first two axes.
  std::optional<Symmetries> polyhedral() const {
    if (axes_.size() < 2 || axes_[1].order < 3 || axes_[0].order == 0) return {};
    for (const Index order : {5, 4, 3}) {
      const Passed turns = placed_on_axes(polyhedral_group(order, false, false));
      if (!turns) continue;
      const auto has = [&](const Matrix3& element) {
        return test_.tried(turns->pose, {element}).has_value();
      };
      const bool inversion = has(-Matrix3::Identity());
      const bool mirror = !inversion && order == 3 && has(reflection(Vector3(1, -1, 0)));
      for (const PointGroup& group :
           {polyhedral_group(order, inversion, mirror), polyhedral_group(order, false, false)})
        if (auto found = verified({group, turns->pose, turns->vote.fit})) return found;
    }
    return {};
  }

  // Where two axes of the turns lie along the first two that were found.
  Passed placed_on_axes(const PointGroup& turns) const {
    constexpr std::ptrdiff_t some = 4;
    const Vector3 a = axes_[0].z(), b = axes_[1].z();
    const std::vector<Matrix3> elements(turns.elements.begin() + 1,
                                        turns.elements.begin() + 1 + some);
    const std::vector<PointGroup::Axis> ideal = turns.axes();
    const auto first = std::find_if(ideal.begin(), ideal.end(), [&](const PointGroup::Axis& axis) {
      return axis.order == axes_[0].order;
    });
    if (first == ideal.end()) return {};
    Passed best;
    for (const PointGroup::Axis& second : ideal) {
      const double cosine = first->direction.dot(second.direction);
      if (second.order != axes_[1].order ||
          std::abs(std::abs(cosine) - std::abs(a.dot(b))) > same_direction)
        continue;
      const Vector3 other = cosine * a.dot(b) < 0 ? Vector3(-second.direction) : second.direction;
      const GroupPose pose{basis_of(a, b) * basis_of(first->direction, other).transpose(), centre_};
      const auto passed = test_.tried(pose, elements);
      if (passed && (!best || passed->vote.fit > best->vote.fit)) best = passed;
    }
    return best;
  }

  // About the axes of the highest order first, and of the groups about these the largest: where one
  // fails, those that it holds and its like about the other axes are left.
  std::optional<Symmetries> axial() const {
    for (auto first = axes_.begin(); first != axes_.end();) {
      const auto last = std::find_if(first, axes_.end(), [&](const FoundDirection& axis) {
        return axis.order != first->order;
      });
      std::vector<Placed> groups;
      for (; first != last; ++first) {
        const std::vector<Placed> some = about(*first);
        groups.insert(groups.end(), some.begin(), some.end());
      }
      std::stable_sort(groups.begin(), groups.end(), [](const Placed& a, const Placed& b) {
        return a.group.elements.size() > b.group.elements.size();
      });
      for (const Placed& placed : groups)
        if (std::optional<Symmetries> found = verified(placed)) return found;
    }
    return {};
  }

  // The best of the groups of one element beside the identity.
  std::optional<Symmetries> of_two() const {
    std::vector<std::pair<double, Placed>> groups;
    for (const FoundDirection& plane : planes_)
      groups.push_back({plane.vote.share(), {reflection_group(), plane.pose}});
    for (const FoundDirection& axis : axes_)
      if (axis.order == 2) groups.push_back({axis.vote.share(), {axial_group(2, {}), axis.pose}});
    if (const auto inverted = test_.tried({}, {Matrix3(-Matrix3::Identity())}))
      groups.push_back({inverted->vote.share(), {inversion_group(), inverted->pose}});
    std::stable_sort(groups.begin(), groups.end(),
                     [](const auto& a, const auto& b) { return a.first > b.first; });
    for (const auto& [share, placed] : groups)
      if (std::optional<Symmetries> found = verified(placed)) return found;
    return {};
  }

  // The group of all that there is about an axis, then groups of less.
  std::vector<Placed> about(const FoundDirection& axis) const {
    const auto order = static_cast<double>(std::max<Index>(1, axis.order));
    const Matrix3 across = reflection(Vector3::UnitZ());
    const Matrix3 rotary = turn(Vector3::UnitZ(), std::numbers::pi / order) * across;
    AxialElements has;
    GroupPose pose = axis.pose;  // the turns leave it free along the axis
    // Whether the first of two, of which a round body may seem to have either; where it fits no
    // worse than the turns the other is not asked for.
    const auto is_first = [&](const Passed& one, const auto& other) {
      if (!one || one->vote.fit >= axis.vote.fit - below_turns) return one.has_value();
      const Passed second = other();
      return !second || one->vote.fit >= second->vote.fit;
    };
    const Passed flat = test_.tried(pose, {across});
    const auto turned_flat = [&] {
      return axis.order == 0 ? Passed() : test_.tried(pose, {rotary});
    };
    has.across = is_first(flat, turned_flat);
    const Passed level = has.across ? flat : turned_flat();
    has.rotary = level && !has.across;
    if (level) pose.centre = level->pose.centre;
    const Passed upright = scanned(axis, pose, reflection(Vector3::UnitX()));
    const auto half_turned = [&] {
      return scanned(axis, pose, turn(Vector3::UnitX(), std::numbers::pi));
    };
    has.vertical = is_first(upright, half_turned);
    const Passed standing = has.vertical ? upright : half_turned();
    has.twofold = standing && !has.vertical;
    if (standing) pose = standing->pose;
    const std::array<AxialElements, 4> choices{has,
                                               {.vertical = has.vertical, .twofold = has.twofold},
                                               {.across = has.across, .rotary = has.rotary},
                                               {}};
    std::vector<Placed> groups;
    for (const AxialElements& some : choices) {
      const PointGroup group = axial_group(axis.order, some);
      if (group.elements.size() <= 2 && axis.order == 2) continue;  // of_two() weighs these
      const bool is_new = std::none_of(groups.begin(), groups.end(), [&](const Placed& other) {
        return other.group.name == group.name;
      });
      if (is_new) groups.push_back({group, pose, axis.vote.fit});
    }
    return groups;
  }

  // The pose turned about its z to where the element along x is a symmetry.
  Passed scanned(const FoundDirection& axis, const GroupPose& about, const Matrix3& element) const {
    constexpr double width = 0.035;  // radians
    const Index order = std::max<Index>(1, axis.order);
    const double period = std::numbers::pi / static_cast<double>(order);
    std::vector<std::pair<double, GroupPose>> starts;
    const auto add = [&](const Vector3& x) {
      const GroupPose pose = with_x(about, x);
      starts.emplace_back(test_.fit().support(pose, element, rough_tolerance), pose);
    };
    for (const FoundDirection& plane : planes_)
      if (std::abs(plane.z().dot(axis.z())) < same_direction) {
        add(plane.z());
        add(plane.z().cross(axis.z()));
      }
    for (double angle = 0; angle < (axis.order == 0 ? width : period); angle += width)
      add(turn(axis.z(), angle) * Vector3(axis.pose.axes.col(0)));
    std::stable_sort(starts.begin(), starts.end(),
                     [](const auto& a, const auto& b) { return a.first > b.first; });
    constexpr std::size_t most = 4;
    constexpr double good_enough = 0.01;  // fit below that of the turns
    suppress_non_maxima(starts, most, [](const auto& a, const auto& b) {
      return are_parallel(a.second.axes.col(0), b.second.axes.col(0), 2.5 * width);
    });
    // With the turns, which hold the axis where it is.
    std::vector<Matrix3> elements{element};
    if (axis.order > 1) elements.push_back(turns_of(axis.order, 1).front());
    Passed best;
    for (const auto& [support, start] : starts) {
      const auto found = test_.tried(start, elements);
      if (found && (!best || found->vote.fit > best->vote.fit)) best = found;
      if (best && best->vote.fit >= axis.vote.fit - good_enough) break;
    }
    return best;
  }

  std::optional<Symmetries> verified(const Placed& placed) const {
    std::vector<Matrix3> elements = placed.group.elements;
    const bool continuous = placed.group.continuous || placed.group.all;
    if (continuous) {
      // About every axis, as of K two make all turns.
      constexpr int turns = 8;
      for (const PointGroup::Axis& axis : placed.group.axes())
        if (axis.order == 0)
          for (const Matrix3& turned : any_turns(axis.direction, turns))
            for (const Matrix3& element : placed.group.elements)
              elements.push_back(turned * element);
    }
    const auto passed = test_.passed(placed.pose, elements, continuous);
    if (!passed || passed->vote.fit < placed.expected - below_turns) return {};
    Symmetries found = described(placed.group, passed->pose, passed->vote, cloud_.frame);
    if (!accepts_(found)) return {};
    return found;
  }

  const Cloud& cloud_;
  const std::function<bool(Symmetries&)>& accepts_;
  const Context& context_;
  SymmetryTest test_;
  std::vector<FoundDirection> planes_, axes_;
  Vector3 centre_ = Vector3::Zero();
};

}  // namespace

Symmetries described(const PointGroup& group, const GroupPose& pose, const OrbitVote& vote,
                     const PrincipalFrame& frame) {
  const Matrix3 axes = frame.axes * pose.axes;
  Symmetries found;
  found.group = group.name;
  found.centre = frame.from_frame(pose.centre);
  for (const Vector3& normal : group.plane_normals()) {
    const Vector3 unit = pose.axes * normal;
    found.planes.push_back(in_input_units(UnitPlane{unit, -unit.dot(pose.centre)}, frame));
  }
  for (const PointGroup::Axis& axis : group.axes())
    found.axes.push_back({found.centre, axes * axis.direction, axis.order});
  found.inversion = group.inversion();
  for (const Matrix3& element : group.elements) {
    if (element.isIdentity(0))  // else it would be one but for rounding
      found.elements.emplace_back(Matrix4::Identity());
    else
      found.elements.push_back(
          map_taking(axes * element * axes.transpose(), found.centre, found.centre).matrix());
  }
  found.score = std::clamp(vote.support, 0.0, 1.0);  // rounding; the support may be negative
  found.missing = vote.missing;
  return found;
}

Symmetries search_symmetries(const Cloud& cloud, double minimum_score, bool is_limited,
                             const std::function<bool(Symmetries&)>& accepts,
                             const Context& context) {
  return SymmetrySearch(cloud, minimum_score, is_limited, accepts, context).run();
}

namespace {

// How far maps take a shape off itself: the greatest distance from the image of a vertex to the
// surface, of a cloud from that of a point to the nearest point (Hodan et al. 2020, who call a map
// a symmetry up to a limit of it).
class Deviation {
 public:
  // A cloud, or a mesh with its vertices as points.
  Deviation(const Cloud& shape, const Context& context);

  // Of each map, in the unit of the points; looks at about as many images in all.
  std::vector<double> of(const std::vector<Matrix4>& maps, Index looked,
                         const Context& context) const;
  bool keeps(const Matrix3& turn, const Vector3& centre, PointsView samples, double limit) const;

  // A mesh with both sides of each edge: it has no side that nobody saw.
  bool is_closed() const { return is_closed_; }
  Points vertices() const { return chosen_rows(shape_.points, vertices_); }

 private:
  double squared_distance(const Vector3& x) const;

  Cloud shape_;
  const PointTree& tree_;
  std::vector<Index> vertices_;
  std::optional<ClosestPointOnMesh> surface_;
  bool is_closed_ = false;
};

Deviation::Deviation(const Cloud& shape, const Context& context)
    : shape_(shape), tree_(shape.tree(context)) {
  const PointsView points = shape.points;
  const TrianglesView faces = shape.faces;
  if (!faces.empty()) surface_.emplace(points, faces, context);
  std::vector<bool> is_vertex(points.size(), faces.empty());
  for (Index f = 0; f < faces.size(); ++f)
    for (int c = 0; c < 3; ++c) is_vertex[faces[f][c]] = true;
  for (const Index i : tree_.order())
    if (is_vertex[i] && points[i].allFinite()) vertices_.push_back(i);
  if (faces.empty()) return;
  const std::vector<bool> rim = TriangleMesh(points, faces, context).is_boundary();
  is_closed_ = std::none_of(rim.begin(), rim.end(), [](bool is) { return is; });
}

bool Deviation::keeps(const Matrix3& turn, const Vector3& centre, PointsView samples,
                      double limit) const {
  constexpr Index looked = 2000;
  for (Index i = 0; i < samples.size(); i += 1 + samples.size() / looked)
    if (squared_distance(centre + turn * (samples[i] - centre)) > limit * limit) return false;
  return true;
}

double Deviation::squared_distance(const Vector3& x) const {
  return surface_ ? (*surface_)(x).squared_distance : tree_.nearest(x).squared_distance;
}

std::vector<double> Deviation::of(const std::vector<Matrix4>& maps, Index looked,
                                  const Context& context) const {
  const auto count = static_cast<Index>(vertices_.size()), all = static_cast<Index>(maps.size());
  const Index stride = std::max<Index>(1, count * all / looked);
  std::vector<double> deviations(maps.size(), 0);
  parallel_for(context, all, 1, [&](Index begin, Index end) {
    for (Index m = begin; m < end; ++m) {
      if (maps[m].isIdentity(0)) continue;
      double greatest = 0;
      for (Index k = 0; k < count; k += stride) {
        context.check();
        const Vector3 image = (maps[m] * shape_.points[vertices_[k]].homogeneous()).head<3>();
        greatest = std::max(greatest, squared_distance(image));
      }
      deviations[m] = std::sqrt(greatest);
    }
  });
  return deviations;
}

Eigen::MatrixXd column(const std::vector<double>& values) {
  return Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Index>(values.size()));
}

void run_symmetries(const ColouredCloud& cloud, const ParameterValues& values,
                    const Context& context, AnalysisResult& result) {
  SymmetryOptions options;
  options.faces = cloud.faces;
  options.minimum_score = values.real("minimum_score");
  options.tolerance = values.real("tolerance");
  if (values.boolean("texture")) {
    if (cloud.colours.size() == 0)
      throw InvalidInput(
          "texture is true, but no colours are given; allowed is a colour per point");
    options.colours = cloud.colours;
  }
  Symmetries found = find_symmetries(cloud.points, options, context);
  constexpr double rounding = 1e-5;  // radians and diagonals: that of sets in single precision
  for (const Matrix4& element : found.elements)
    result.transformations.push_back(
        {kind_of(element, found.centre, rounding, rounding * cloud.diagonal),
         element,
         found.score,
         {},
         {}});
  const std::vector<double>& deviations = found.max_deviations;
  result.planes = std::move(found.planes);
  result.axes = std::move(found.axes);
  result.statistics = {{"group", found.group},
                       {"centre", found.centre},
                       {"inversion", found.inversion},
                       {"score", found.score},
                       {"missing", found.missing},
                       {"max_deviation", *std::max_element(deviations.begin(), deviations.end())},
                       {"max_deviations", column(deviations)}};
  if (!found.axis_max_deviations.empty())
    result.statistics["axis_max_deviations"] = column(found.axis_max_deviations);
}

// Fills in how far the elements, and some turns about continuous axes, take the shape off itself.
// Whether all are within the tolerance.
bool deviates_little(Symmetries& found, const Deviation& deviation, double tolerance,
                     const Context& context) {
  constexpr Index looked = 100'000;  // images: less than a second
  constexpr int turns = 8;
  std::vector<Matrix4> maps = found.elements;
  for (const SymmetryAxis& axis : found.axes) {
    if (axis.order != 0) continue;
    for (const Matrix3& turned : any_turns(axis.direction, turns))
      maps.push_back(map_taking(turned, axis.point, axis.point).matrix());
  }
  const std::vector<double> deviations = deviation.of(maps, looked, context);
  const auto end = deviations.begin() + static_cast<std::ptrdiff_t>(found.elements.size());
  found.max_deviations.assign(deviations.begin(), end);
  found.axis_max_deviations.clear();
  for (auto first = end; first != deviations.end(); first += turns)
    found.axis_max_deviations.push_back(*std::max_element(first, first + turns));
  return !(tolerance > 0) || *std::max_element(deviations.begin(), deviations.end()) <= tolerance;
}

// What points have at most: half a unit of the last decimal that all of them have, along each axis,
// twice. 0 of coordinates with more decimals, or too few to tell a shape by.
double rounding_of(PointsView points, double diagonal) {
  constexpr double most = 1e-3;  // diagonals
  double unit = 1;
  for (int decimals = 0; decimals <= 6; ++decimals, unit /= 10) {
    const Eigen::ArrayXXd steps = points.matrix().array() / unit;
    const bool fits = ((steps - steps.round()).abs() < 1e-6 * (1 + steps.abs())).all();
    if (fits && unit < most * diagonal) return std::sqrt(3.0) * unit;
  }
  return 0;
}

// The group of the maps that take a small set, or the vertices of a mesh and its faces, exactly
// onto themselves; C1 of others.
Symmetries exact_symmetries(const Cloud& cloud, const Deviation& shape, bool is_set,
                            double tolerance, const Context& context) {
  constexpr Index most_points = 1000, most_vertices = 20'000;
  constexpr std::size_t most = 512;
  constexpr double rounding = 1e-5;  // diagonals
  const Points vertices = is_set ? Points(cloud.points.matrix()) : shape.vertices();
  if (vertices.rows() > (is_set ? most_points : most_vertices)) return described({}, {}, {}, {});
  const PointTree tree(vertices, context);
  const double reach = is_set ? std::max(tolerance, rounding_of(vertices, cloud.diagonal)) : 0;
  const ExactIsometries maps =
      exact_isometries(vertices, tree, context, most, std::numeric_limits<Index>::max(), reach);
  std::vector<Matrix3> elements = polished(maps.maps);
  const bool is_kept =
      !elements.empty() && elements.size() < most &&
      std::all_of(maps.generators.begin(), maps.generators.end(), [&](const Matrix3& generator) {
        return is_set ||
               shape.keeps(generator, maps.centre, cloud.points, rounding * cloud.diagonal);
      });
  if (!is_kept) elements = {Matrix3::Identity()};
  for (Matrix3& map : elements)
    if (!map.isIdentity(0)) map = cloud.frame.axes.transpose() * map * cloud.frame.axes;
  const GroupPose pose{Matrix3::Identity(), cloud.frame.to_frame(maps.centre)};
  return described(PointGroup(elements), pose, {.support = 1}, cloud.frame);
}

// Whether a group has more elements than the exact ones, all of them to within what tessellation
// takes off: of a body of revolution less than of a prism of 64 sides, which is none; of others, as
// of a ball that is drawn coarsely or has studs, more.
bool has_more(const Symmetries& found, const Symmetries& exact, double diagonal) {
  constexpr double of_revolution = 2e-4, of_others = 1e-2;  // diagonals
  if (exact.elements.size() == 1) return true;
  std::vector<double> deviations = found.max_deviations;
  deviations.insert(deviations.end(), found.axis_max_deviations.begin(),
                    found.axis_max_deviations.end());
  const bool is_continuous = std::any_of(found.axes.begin(), found.axes.end(),
                                         [](const SymmetryAxis& axis) { return axis.order == 0; });
  const double most = is_continuous && found.group != "K" ? of_revolution : of_others;
  return (is_continuous || found.elements.size() > exact.elements.size()) &&
         *std::max_element(deviations.begin(), deviations.end()) <= most * diagonal;
}

void run_prepared(PointsView points, TrianglesView faces, bool refuse_nonfinite,
                  const std::function<void(const Cloud&, const Context&)>& search,
                  const Context& context) {
  MethodImplementation searching;  // in place of the method
  searching.name = "symmetries";
  searching.preprocessing = Preprocessing::none();
  searching.preprocessing.remove_outliers = true;
  searching.preprocessing.sample_faces = true;
  searching.preprocessing.merge_duplicates = true;
  searching.run = [&](const Cloud& cloud, const ParameterValues&, const Context& running) {
    search(cloud, running);
    return Result{};
  };
  Cloud cloud(points);
  cloud.faces = faces;
  run_pipeline(searching, {}, cloud, refuse_nonfinite, context);
}

}  // namespace

Symmetries find_symmetries(PointsView points, const SymmetryOptions& options,
                           const Context& context) {
  if (!(options.minimum_score >= 0 && options.minimum_score <= 1))
    throw InvalidParameter("minimum_score is " + to_string(Value(options.minimum_score)) +
                           "; allowed is [0, 1]");
  if (!(options.tolerance >= 0 && std::isfinite(options.tolerance)))
    throw InvalidParameter("tolerance is " + to_string(Value(options.tolerance)) +
                           "; allowed is [0, inf)");
  require_colours(points, options.colours);
  const auto start = std::chrono::steady_clock::now();
  Symmetries found;
  Cloud whole(points);
  whole.faces = options.faces;
  const auto search = [&](const Cloud& cloud, const Context& running) {
    const bool is_cloud = options.faces.empty();
    const Deviation deviation(is_cloud ? cloud : whole, running.stage(0, 0));
    // A closed mesh has no side that nobody saw: what maps a part of it elsewhere is no symmetry.
    constexpr double farthest = 0.1;  // diagonals
    const double limit = options.tolerance > 0   ? options.tolerance
                         : deviation.is_closed() ? farthest * cloud.diagonal
                                                 : 0;
    double done = 0.1;
    const auto accepts = [&](Symmetries& group) {
      return deviates_little(group, deviation, limit, running.stage(done, done));
    };
    found = exact_symmetries(cloud, deviation, is_cloud, options.tolerance, running.stage(0, 0.1));
    const bool is_exact = accepts(found) && found.elements.size() > 1;
    constexpr Index least_searched = 30;  // points: fewer show no surface
    if (!is_cloud || (!is_exact && cloud.points.size() >= least_searched)) {
      done = 1;
      Symmetries searched = search_symmetries(cloud, options.minimum_score, options.tolerance > 0,
                                              accepts, running.stage(0.1, 1));
      if (!is_exact || has_more(searched, found, cloud.diagonal)) found = std::move(searched);
    }
    if (options.colours.size() > 0) {
      const Context last = running.stage(1, 1);
      const ColouredSurface surface(points, options.faces, options.colours, last);
      found = coloured_group(found, surface, last);
      deviates_little(found, deviation, 0, last);
    }
  };
  run_prepared(points, options.faces, options.refuse_nonfinite, search, context);
  context.report(1);
  found.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return found;
}

std::optional<SymmetryAxis> find_axis(PointsView points, TrianglesView faces,
                                      const Context& context) {
  SymmetryOptions options;
  options.faces = faces;
  options.refuse_nonfinite = true;
  const Symmetries group = find_symmetries(points, options, context.stage(0, 0.8));
  if (!group.axes.empty()) return group.axes.front();
  std::optional<SymmetryAxis> found;
  const auto search = [&](const Cloud& cloud, const Context& running) {
    const SymmetryTest test(cloud, options.minimum_score, false, running);
    if (const auto part = find_revolution(cloud, test, running))
      found = SymmetryAxis{cloud.frame.from_frame(part->axis.pose.centre),
                           cloud.frame.axes * part->axis.z(), 0};
  };
  run_prepared(points, faces, true, search, context.stage(0.8, 1));
  return found;
}

AnalysisImplementation symmetries_analysis() {
  AnalysisImplementation analysis;
  analysis.name = "symmetries";
  analysis.title = "Symmetry group";
  analysis.summary =
      "Finds all symmetries of a shape: mirror planes, rotation axes, inversion, and their point "
      "group.";
  analysis.parameters = {
      Parameter::real("minimum_score", 0.7, 0, 1, "", "Minimum score of a group that counts."),
      Parameter::real(
          "tolerance", 0, 0, infinity, "input units",
          "Maximum distance of the image of a vertex from the surface, or of the image of a "
          "cloud's point from its nearest point, under any element of the group; 0: no limit."),
      Parameter::boolean("texture", false,
                         "Symmetries must also preserve the colours of the points: a label breaks "
                         "the symmetry of a bottle.")};
  analysis.takes_colours = true;
  analysis.finds_elements = true;
  analysis.finds_transforms = true;
  analysis.run = run_symmetries;
  return analysis;
}

}  // namespace symsurf
