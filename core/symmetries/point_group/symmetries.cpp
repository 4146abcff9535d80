#include <symsurf/analyses.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <utility>

#include "analysis.h"
#include "base/linear_algebra.h"
#include "base/math.h"
#include "detection/pipeline.h"
#include "point_group/group_search.h"
#include "point_group/point_group.h"
#include "point_group/surface_distance.h"

namespace symsurf {

Symmetries described(const HeldGroup& held, const PrincipalFrame& frame) {
  const auto& [group, pose, deviation] = held;
  const Matrix3 axes = frame.axes * pose.axes;
  Symmetries found;
  found.group = group.name;
  found.centre = frame.from_frame(pose.centre);
  for (const Vector3& normal : group.plane_normals()) {
    const Vector3 unit = pose.axes * normal;
    found.planes.push_back(in_input_units({unit, -unit.dot(pose.centre)}, frame));
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
  found.score = deviation.near;
  found.missing = deviation.missing;
  return found;
}

namespace {

constexpr double most_missing = 0.35;  // share of the images
constexpr double most_alone = 0.035;   // share of the samples: a nose of a twentieth is none
constexpr Index all_images = 100'000;  // a tenth of a second
constexpr Index most_set_points = 1000;
constexpr Index least_points_of_surface = 100;

// What a group may be off the shape.
class Rule {
 public:
  Rule(const SymmetryOptions& options, const SurfaceDistance& surface, double size)
      : name_(options.tolerance > 0 && options.tolerance_rule == "rounding"
                  ? "given"
                  : options.tolerance_rule),
        minimum_score_(options.minimum_score) {
    const double diameter = surface.diameter();
    // Shares of the diameter that people accepted of the objects of pose benchmarks.
    constexpr double finite = 0.025, continuous = 0.05;
    if (name_ == "object") {
      finite_ = finite * diameter;
      continuous_ = continuous * diameter;
    } else {
      constexpr double benchmark = 0.1, millimetres = 15;  // Hodan et al. 2020
      finite_ = continuous_ = name_ == "given" ? options.tolerance / size
                              : name_ == "bop" ? std::max(benchmark * diameter, millimetres / size)
                                               : surface.rounding();
    }
  }

  double finite() const { return finite_; }
  bool is_given() const { return name_ == "given"; }

  double limit(const HeldGroup& held) const {
    return held.group.continuous || held.group.all ? continuous_ : finite_;
  }

  double excess(const HeldGroup& held) const {
    const MapDeviation& off = held.deviation;
    return (name_ == "object" ? off.quantile : off.greatest) / limit(held);
  }

  bool may_hold(const HeldGroup& held, const HeldGroup& exact) const {
    return excess(held) <= 1 && !is_prism(held, exact);
  }

  bool allows(const HeldGroup& held) const {
    const MapDeviation& off = held.deviation;
    return excess(held) <= 1 && off.near >= minimum_score_ && off.missing <= most_missing &&
           off.alone <= most_alone;
  }

 private:
  // Facets that are exactly alike are those of a prism; only many stand for a round surface.
  bool is_prism(const HeldGroup& held, const HeldGroup& exact) const {
    constexpr Index most_sides = 64;
    const std::vector<PointGroup::Axis> axes = exact.group.axes();
    return name_ == "rounding" && held.group.continuous && !axes.empty() && axes[0].order > 2 &&
           axes[0].order <= most_sides;
  }

  std::string name_;
  double minimum_score_, finite_, continuous_;
};

// The largest group that the rule allows, measured by many images.
HeldGroup largest(std::vector<HeldGroup>& groups, const SurfaceDistance& surface, const Rule& rule,
                  const Context& context) {
  const HeldGroup exact = groups.front();
  std::stable_sort(groups.begin(), groups.end(), [&](const HeldGroup& a, const HeldGroup& b) {
    return a.size() > b.size() || (a.size() == b.size() && rule.excess(a) < rule.excess(b));
  });
  for (HeldGroup& held : groups) {
    context.check();
    if (held.size() == 1 || !rule.may_hold(held, exact)) continue;
    held.deviation = surface.deviation(held.maps(), all_images, rule.limit(held));
    if (rule.allows(held)) return held;
  }
  return {};
}

// Groups by their deviation, each of which is larger than that before and holds it; the one that
// was found among them.
std::vector<HeldGroup> chain_of(std::vector<HeldGroup> groups, const HeldGroup& found) {
  std::stable_sort(groups.begin(), groups.end(), [](const HeldGroup& a, const HeldGroup& b) {
    return std::pair(a.deviation.greatest, -a.size()) < std::pair(b.deviation.greatest, -b.size());
  });
  std::vector<HeldGroup> chain{HeldGroup{}};
  const auto add = [&](const HeldGroup& held) {
    if (held.size() > chain.back().size() && held.holds(chain.back())) chain.push_back(held);
  };
  for (const HeldGroup& held : groups)
    if (held.deviation.greatest <= found.deviation.greatest && found.holds(held) &&
        held.size() < found.size())
      add(held);
  if (found.size() > 1) add(found);
  for (const HeldGroup& held : groups)
    if (held.deviation.greatest > found.deviation.greatest) add(held);
  if (chain.size() > 1 && chain[1].deviation.greatest == 0) chain.erase(chain.begin());
  return chain;
}

// Of each element, and of the turns about continuous axes.
void fill_in_deviations(Symmetries& found, const SurfaceDistance& surface,
                        const PrincipalFrame& frame) {
  constexpr int turns = 8;
  const auto deviation = [&](const std::vector<Matrix4>& maps, Index images) {
    std::vector<Eigen::Isometry3d> placed;
    for (const Matrix4& map : maps) {
      const Matrix3 linear = frame.axes.transpose() * map.topLeftCorner<3, 3>() * frame.axes;
      const Vector3 centre = frame.to_frame(found.centre);
      placed.push_back(map_taking(linear, centre, centre));
    }
    return surface.deviation(placed, images).greatest * frame.size;
  };
  found.max_deviations.clear();
  found.axis_max_deviations.clear();
  for (const Matrix4& element : found.elements)
    found.max_deviations.push_back(
        element.isIdentity(0)
            ? 0
            : deviation({element}, all_images / static_cast<Index>(found.elements.size())));
  for (const SymmetryAxis& axis : found.axes) {
    if (axis.order != 0) continue;
    std::vector<Matrix4> maps;
    for (const Matrix3& turned : any_turns(axis.direction, turns))
      maps.push_back(map_taking(turned, axis.point, axis.point).matrix());
    found.axis_max_deviations.push_back(deviation(maps, all_images / 4));
  }
}

// Part of a surface of revolution, whose axis whole turns do not find.
std::optional<HeldGroup> partly_turned(const Cloud& cloud, const SurfaceDistance& surface,
                                       const Rule& rule, const HeldGroup& found,
                                       const Context& context) {
  constexpr double whole_turn = 0.95;
  if (surface.is_closed() || found.group.continuous || found.group.all) return {};
  const std::optional<Revolution> part = find_revolution(cloud, surface, context);
  if (!part || part->turn > whole_turn) return {};
  HeldGroup held{axial_group(0, {.vertical = true}), part->pose, part->deviation};
  if (!rule.allows(held)) return {};
  held.deviation.missing = 1 - part->turn;
  return held;
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

Symmetries found_in(const Cloud& cloud, const Cloud& whole, const SymmetryOptions& options,
                    const Context& context) {
  const bool is_cloud = whole.faces.empty();
  const Cloud& shape = is_cloud ? cloud : whole;
  for (const bool is_set : {true, false}) {
    if (is_set && (!is_cloud || cloud.points.size() > most_set_points)) continue;
    const SurfaceDistance surface(shape, cloud.frame, is_set, context.stage(0, 0.1));
    const Rule rule(options, surface, cloud.frame.size);
    std::vector<HeldGroup> groups =
        possible_groups(shape, cloud.frame, surface, rule.finite(), context.stage(0.1, 0.8));
    HeldGroup found = largest(groups, surface, rule, context);
    if (is_set && found.size() == 1 && cloud.points.size() >= least_points_of_surface &&
        !rule.is_given())
      continue;
    if (!is_set)
      if (const auto part = partly_turned(cloud, surface, rule, found, context.stage(0.8, 1)))
        found = *part;
    Symmetries result = described(found, cloud.frame);
    for (const HeldGroup& held : chain_of(std::move(groups), found))
      result.by_tolerance.push_back({held.group.name, held.deviation.greatest * cloud.frame.size,
                                     held.deviation.quantile * cloud.frame.size});
    result.diameter = surface.diameter() * cloud.frame.size;
    if (options.colours.size() > 0) {
      const ColouredSurface colours(whole.points, whole.faces, options.colours, context);
      Symmetries kept = coloured_group(result, colours, context);
      kept.by_tolerance = std::move(result.by_tolerance);
      kept.diameter = result.diameter;
      result = std::move(kept);
    }
    fill_in_deviations(result, surface, cloud.frame);
    return result;
  }
  return {};
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
  options.tolerance_rule = values.choice("tolerance_rule");
  if (values.boolean("texture")) {
    if (cloud.colours.size() == 0)
      throw InvalidInput("texture is true, but no colours are given; allowed is a colour a point");
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
  std::string groups;
  Eigen::MatrixXd by_tolerance(static_cast<Index>(found.by_tolerance.size()), 2);
  for (Index k = 0; k < by_tolerance.rows(); ++k) {
    const GroupTolerance& held = found.by_tolerance[k];
    groups += (k > 0 ? " " : "") + held.group;
    by_tolerance.row(k) << held.greatest, held.quantile;
  }
  result.statistics = {{"group", found.group},
                       {"centre", found.centre},
                       {"inversion", found.inversion},
                       {"score", found.score},
                       {"missing", found.missing},
                       {"diameter", found.diameter},
                       {"groups", groups},
                       {"by_tolerance", by_tolerance},
                       {"max_deviation", *std::max_element(deviations.begin(), deviations.end())},
                       {"max_deviations", column(deviations)}};
  if (!found.axis_max_deviations.empty())
    result.statistics["axis_max_deviations"] = column(found.axis_max_deviations);
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
  run_prepared(
      points, options.faces, options.refuse_nonfinite,
      [&](const Cloud& cloud, const Context& running) {
        found = found_in(cloud, whole, options, running);
      },
      context);
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
  Cloud whole(points);
  whole.faces = faces;
  const auto search = [&](const Cloud& cloud, const Context& running) {
    const SurfaceDistance surface(faces.empty() ? cloud : whole, cloud.frame, false, running);
    const auto part = find_revolution(cloud, surface, running);
    if (part && part->deviation.near >= options.minimum_score &&
        part->deviation.missing <= most_missing)
      found = SymmetryAxis{cloud.frame.from_frame(part->pose.centre),
                           cloud.frame.axes * part->pose.axes.col(2), 0};
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
      Parameter::real("minimum_score", 0.7, 0, 1, "", "What the group must score for it to count."),
      Parameter::real("tolerance", 0, 0, infinity, "input units",
                      "How far elements may take the shape off itself; 0: by the tolerance rule."),
      Parameter::choice("tolerance_rule", "rounding", {"rounding", "given", "object", "bop"},
                        "rounding: a thousandth of the diameter, or what facets, decimals or noise "
                        "explain; given: "
                        "the tolerance; object: as people judge real objects, 95 % of the surface "
                        "within 2.5 % of "
                        "the diameter, of continuous axes 5 %; bop: the BOP challenge's limit, the "
                        "larger of 15 mm "
                        "and a tenth of the diameter, for coordinates in mm."),
      Parameter::boolean("texture", false,
                         "Only what keeps the colours of the points is a symmetry: a label breaks "
                         "that of a bottle.")};
  analysis.takes_colours = true;
  analysis.finds_elements = true;
  analysis.finds_transforms = true;
  analysis.run = run_symmetries;
  return analysis;
}

}  // namespace symsurf
