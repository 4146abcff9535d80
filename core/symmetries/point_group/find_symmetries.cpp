#include <symsurf/analyses.h>
#include <symsurf/context.h>
#include <symsurf/parameter.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "analysis.h"
#include "base/linear_algebra.h"
#include "base/math.h"
#include "cloud/exact_isometries.h"
#include "detection/pipeline.h"
#include "point_group/point_group.h"
#include "point_group/surface_distance.h"
#include "point_group/symmetry_search.h"
#include "point_group/tolerance_chain.h"

namespace symsurf {

namespace {

Eigen::MatrixXd column(const std::vector<double>& values) {
  return Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Index>(values.size()));
}

// The names of a chain with the tolerances, in input units: "C1 0, C6v 0.0012, D∞h 0.31".
std::string chain_text(const std::vector<Symmetries>& chain) {
  std::ostringstream text;
  text.precision(3);
  for (const Symmetries& group : chain)
    text << (&group == &chain.front() ? "" : ", ") << group.group << ' ' << group.max_deviation();
  return text.str();
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
  result.statistics = {{"group", found.group},
                       {"centre", found.centre},
                       {"inversion", found.inversion},
                       {"score", found.score},
                       {"missing", found.missing},
                       {"max_deviation", found.max_deviation()},
                       {"quantile_deviation", found.quantile_deviation()},
                       {"max_deviations", column(found.max_deviations)},
                       {"quantile_deviations", column(found.quantile_deviations)}};
  if (!found.axis_max_deviations.empty()) {
    result.statistics["axis_max_deviations"] = column(found.axis_max_deviations);
    result.statistics["axis_quantile_deviations"] = column(found.axis_quantile_deviations);
  }
  result.statistics["by_tolerance"] = chain_text(found.by_tolerance);
  result.by_tolerance = std::move(found.by_tolerance);
  result.planes = std::move(found.planes);
  result.axes = std::move(found.axes);
}

// A group that was found, in a frame.
MeasuredGroup standing(const Symmetries& found, const PrincipalFrame& frame) {
  MeasuredGroup own;
  own.pose.centre = frame.to_frame(found.centre);
  own.deviation.missing = found.missing;
  if (found.group == "K") {
    own.group = spherical_group();
    return own;
  }
  const bool is_continuous = !found.axes.empty() && found.axes.front().order == 0;
  if (is_continuous)
    own.pose =
        GroupPose::along(frame.axes.transpose() * found.axes.front().direction, own.pose.centre);
  const Matrix3 axes = frame.axes * own.pose.axes;
  std::vector<Matrix3> elements;
  for (const Matrix4& element : found.elements)
    elements.push_back(element.isIdentity(0)
                           ? Matrix3(Matrix3::Identity())
                           : Matrix3(axes.transpose() * element.topLeftCorner<3, 3>() * axes));
  own.group = PointGroup(std::move(elements), is_continuous);
  return own;
}

Symmetries with_deviations(Symmetries found, const MeasuredGroup& own,
                           const SurfaceDistance& surface) {
  const auto add = [&](const ImageDeviation& one, std::vector<double>& maxima,
                       std::vector<double>& quantiles) {
    maxima.push_back(surface.diameter() * one.maximum);
    quantiles.push_back(surface.diameter() * one.quantile);
  };
  const std::size_t count = own.group.elements.size();
  for (std::size_t e = 0; e < count; ++e)
    add(own.each[e], found.max_deviations, found.quantile_deviations);
  // Of each axis the turns with all elements.
  const auto axes = std::count_if(found.axes.begin(), found.axes.end(),
                                  [](const SymmetryAxis& axis) { return axis.order == 0; });
  const std::size_t turned = own.each.size() - count;
  for (std::ptrdiff_t k = 0; k < axes; ++k) {
    ImageDeviation of_axis;
    for (std::size_t e = k * turned / axes; e < (k + 1) * turned / axes; ++e)
      of_axis.merge(own.each[count + e]);
    add(of_axis, found.axis_max_deviations, found.axis_quantile_deviations);
  }
  return found;
}

Symmetries in_input_units(const MeasuredGroup& own, double score, const SurfaceDistance& surface) {
  const OrbitVote vote{.support = score, .missing = own.deviation.missing};
  return with_deviations(described(own.group, own.pose, vote, surface.frame()), own, surface);
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
Symmetries exact_symmetries(const Cloud& cloud, const SurfaceDistance& shape, bool is_set,
                            double tolerance, const Context& context) {
  constexpr Index most_points = 1000, most_vertices = 20'000, looked = 2000;
  constexpr std::size_t most = 512;
  constexpr double rounding = 1e-5;  // diameters
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
        const Matrix3 turned = cloud.frame.axes.transpose() * generator * cloud.frame.axes;
        const ImageDeviation off = shape.deviation(
            GroupPose{Matrix3::Identity(), shape.frame().to_frame(maps.centre)}.placed(turned),
            looked);
        return is_set || (off.maximum <= rounding && off.missing == 0);
      });
  if (!is_kept) elements = {Matrix3::Identity()};
  for (Matrix3& map : elements)
    if (!map.isIdentity(0)) map = cloud.frame.axes.transpose() * map * cloud.frame.axes;
  const GroupPose pose{Matrix3::Identity(), cloud.frame.to_frame(maps.centre)};
  return described(PointGroup(elements), pose, {.support = 1}, cloud.frame);
}

// Whether a group has more elements than the exact ones, all of them to within what tessellation
// takes off: about one axis less than of a prism of 64 sides, which is no body of revolution; about
// several, as of a ball that is drawn coarsely or has studs, more.
bool has_more(const MeasuredGroup& found, const MeasuredGroup& exact) {
  constexpr double about_one = 2.5e-4, about_several = 1e-2;  // diameters
  if (exact.size() == 1) return true;
  const std::vector<PointGroup::Axis> axes = found.group.axes();
  const bool is_axial = axes.size() < 2 || axes[1].order == 2;
  return found.size() > exact.size() && is_within(exact, found) &&
         found.deviation.maximum <= (is_axial ? about_one : about_several);
}

// Whether a rule takes a group by how far its elements take the shape off itself.
class ToleranceRule {
 public:
  ToleranceRule(const SymmetryOptions& options, const SurfaceDistance& surface)
      : is_given_(options.tolerance > 0 || options.tolerance_rule != "rounding"),
        by_quantile_(options.tolerance_rule == "object") {
    if (by_quantile_) {
      // What people accept: 95 % quantiles of the published symmetries of benchmark objects.
      most_ = 0.025;
      most_of_continuous_ = 0.05;
    } else if (options.tolerance_rule == "bop") {
      constexpr double least = 15, share = 0.1;  // input units, which BOP's are mm; diameters
      most_ = most_of_continuous_ = std::max(least / surface.diameter(), share);
    } else if (is_given_) {
      most_ = most_of_continuous_ =
          options.tolerance > 0 ? options.tolerance / surface.diameter() : single_rounding;
    } else {
      constexpr double rounding = 1e-3, widest = 1e-2, sagittas = 2;
      most_ = most_of_continuous_ = std::clamp(sagittas * surface.sagitta(), rounding, widest);
    }
  }

  bool is_given() const { return is_given_; }
  bool by_quantile() const { return by_quantile_; }
  bool operator()(const MeasuredGroup& own) const {
    return (by_quantile_ ? own.deviation.quantile : own.deviation.maximum) <=
           (own.is_continuous() ? most_of_continuous_ : most_);
  }

 private:
  bool is_given_, by_quantile_;
  double most_ = 0, most_of_continuous_ = 0;  // diameters
};

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
  const bool by_tolerance =
      options.tolerance_rule == "rounding" || options.tolerance_rule == "given";
  if (!by_tolerance && options.tolerance_rule != "object" && options.tolerance_rule != "bop")
    throw InvalidParameter("tolerance_rule is \"" + options.tolerance_rule +
                           "\"; allowed is given | rounding | object | bop");
  if (!by_tolerance && options.tolerance > 0)
    throw InvalidParameter("tolerance is " + to_string(Value(options.tolerance)) +
                           "; allowed with tolerance_rule \"" + options.tolerance_rule + "\" is 0");
  require_colours(points, options.colours);
  const auto start = std::chrono::steady_clock::now();
  Symmetries found;
  Cloud whole(points);
  whole.faces = options.faces;
  const auto search = [&](const Cloud& cloud, const Context& running) {
    const bool is_cloud = options.faces.empty();
    const SurfaceDistance surface(cloud, is_cloud ? cloud : whole, running.stage(0, 0));
    const ToleranceRule rule(options, surface);
    const auto measured = [&](const Symmetries& some) {
      MeasuredGroup own = standing(some, surface.frame());
      measure(own, surface, running.stage(0.1, 0.1));
      return own;
    };
    const MeasuredGroup exact = measured(
        exact_symmetries(cloud, surface, is_cloud, options.tolerance, running.stage(0, 0.1)));
    TolerancedGroups groups(surface, running.stage(0.1, 0.1));
    groups.add(exact);
    MeasuredGroup own = exact;
    constexpr Index least_searched = 30;  // points: fewer show no surface
    if (rule.is_given()) {
      own = groups.largest(rule, rule.by_quantile());
    } else if (!is_cloud || (exact.size() == 1 && cloud.points.size() >= least_searched)) {
      // A closed mesh has no side that nobody saw: what maps a part of it elsewhere is no symmetry.
      const auto accepts = [&](const Symmetries& group) {
        return !surface.is_closed() || rule(measured(group));
      };
      const Symmetries searched =
          search_symmetries(cloud, options.minimum_score, accepts, running.stage(0.5, 1));
      MeasuredGroup other = measured(searched);
      other.deviation.missing = searched.missing;
      if (has_more(other, exact)) {
        own = std::move(other);
        found = with_deviations(searched, own, surface);
      }
      if (surface.is_closed()) {
        const double size = own.size();
        const MeasuredGroup larger = groups.largest(
            [&](const MeasuredGroup& group) {
              return group.size() > size && rule(group) && has_more(group, exact);
            },
            false);
        if (larger.size() > size) {
          own = larger;
          found.elements.clear();
        }
      }
    }
    if (found.elements.empty())
      found = in_input_units(own, rule.by_quantile() ? quantile_share : 1, surface);
    if (options.colours.size() == 0) {
      for (const MeasuredGroup& each : groups.chain(own, rule.by_quantile()))
        found.by_tolerance.push_back(in_input_units(each, 1, surface));
      return;
    }
    const Context last = running.stage(1, 1);
    const ColouredSurface coloured(points, options.faces, options.colours, last);
    found = coloured_group(found, coloured, last);
    own = measured(found);
    found = in_input_units(own, found.score, surface);
    found.by_tolerance = {in_input_units({}, 1, surface)};
    if (own.size() > 1) found.by_tolerance.push_back(found);
  };
  run_prepared(points, options.faces, options.refuse_nonfinite, search, context);
  context.report(1);
  found.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return found;
}

namespace {

double greatest(const std::vector<double>& of_elements, const std::vector<double>& of_axes) {
  double all = 0;
  for (const std::vector<double>* some : {&of_elements, &of_axes})
    for (const double one : *some) all = std::max(all, one);
  return all;
}

}  // namespace

double Symmetries::max_deviation() const { return greatest(max_deviations, axis_max_deviations); }

double Symmetries::quantile_deviation() const {
  return greatest(quantile_deviations, axis_quantile_deviations);
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
    const SymmetryTest test(cloud, options.minimum_score, running);
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
      Parameter::real("tolerance", 0, 0, infinity, "input units",
                      "Maximum distance of the image of a point from the surface under any element "
                      "of the group; "
                      "0: by tolerance_rule."),
      Parameter::choice(
          "tolerance_rule", "rounding", {"given", "rounding", "object", "bop"},
          "How far elements may take the shape off itself: by at most the tolerance (given); by "
          "rounding and "
          "tessellation; by what pose benchmarks accept, 95 % of the surface within 2.5 % of the "
          "diameter, 5 % of it for continuous axes (object); by at most 15 mm or a tenth of the "
          "diameter (bop)."),
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
