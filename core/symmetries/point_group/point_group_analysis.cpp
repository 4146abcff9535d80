#include <symsurf/analyses.h>
#include <symsurf/context.h>
#include <symsurf/parameter.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <optional>
#include <vector>

#include "analysis_registry.h"
#include "base/eigenvectors.h"
#include "base/math.h"
#include "base/parallel.h"
#include "cloud/closest_point_on_mesh.h"
#include "detection/pipeline.h"
#include "point_group/coloured_group.h"
#include "point_group/coloured_surface.h"
#include "point_group/revolution_search.h"
#include "point_group/symmetry_search.h"
#include "point_group/symmetry_test.h"

namespace symsurf {

namespace {

// How far maps take a shape off itself: the greatest distance from the image of a vertex to the
// surface, of a cloud from that of a point to the nearest point (Hodan et al. 2020, who call a map
// a symmetry up to a limit of it).
class Deviation {
 public:
  // The points must stay alive.
  Deviation(PointsView points, TrianglesView faces, const Context& context);

  // Of each map, in the unit of the points; looks at about as many images in all.
  std::vector<double> of(const std::vector<Matrix4>& maps, Index looked,
                         const Context& context) const;

 private:
  double squared_distance(const Vector3& x) const;

  PointsView points_;
  std::vector<Index> vertices_;
  PointTree tree_;
  std::optional<ClosestPointOnMesh> surface_;
};

Deviation::Deviation(PointsView points, TrianglesView faces, const Context& context)
    : points_(points), tree_(points, context) {
  if (!faces.empty()) surface_.emplace(points, faces, context);
  std::vector<bool> is_vertex(points.size(), faces.empty());
  for (Index f = 0; f < faces.size(); ++f)
    for (int c = 0; c < 3; ++c) is_vertex[faces[f][c]] = true;
  for (const Index i : tree_.order())
    if (is_vertex[i] && points[i].allFinite()) vertices_.push_back(i);
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
        const Vector3 image = (maps[m] * points_[vertices_[k]].homogeneous()).head<3>();
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
  Cloud cloud;
  cloud.points = points;
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
  const auto search = [&](const Cloud& cloud, const Context& running) {
    const bool is_cloud = options.faces.empty();
    const Deviation deviation(is_cloud ? cloud.points : points, options.faces, running.stage(0, 0));
    const auto accepts = [&](Symmetries& group) {
      return deviates_little(group, deviation, options.tolerance, running.stage(1, 1));
    };
    found = search_symmetries(cloud, is_cloud, options.minimum_score, accepts, running);
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
      Parameter::real("minimum_score", 0.7, 0, 1, "", "What the group must score for it to count."),
      Parameter::real(
          "tolerance", 0, 0, infinity, "input units",
          "No element may take a vertex farther off the surface, of a cloud a point off "
          "its nearest one; 0: any may."),
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
