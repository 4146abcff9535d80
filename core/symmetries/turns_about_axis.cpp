#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <string>
#include <utility>

#include "analysis.h"
#include "base/math.h"
#include "cloud/cloud.h"
#include "cloud/surfels.h"
#include "operations/operation.h"
#include "point_group/symmetry_search.h"
#include "preprocess/surface_samples.h"

namespace symsurf {

namespace {

constexpr Index highest_order = 128;
constexpr Index surfels_wanted = 6000;
constexpr Index bins_of_turn = 120;  // 3 degrees: at the rim of a pot about as wide as a surfel
constexpr double cell = 0.03;        // diagonals, along the profile
constexpr double next_to_nothing = 0.003;           // of what is there
constexpr double as_good = 0.98, nearly_all = 0.9;  // of the greatest gain; of what is missing
constexpr Index overlap = 3;                        // bins
// Of the median cell of a body of revolution: what is there along a smaller part of the turn, as a
// handle is, is none of it.
constexpr double least_of_median = 0.3;

// Where a shape has surface: cells of its profile by bins of the turn.
class Coverage {
 public:
  Coverage(const std::vector<Vector3>& positions, const SymmetryAxis& axis, double size)
      : continuous_(axis.order == 0),
        step_(continuous_ ? 1 : (bins_of_turn + axis.order - 1) / axis.order),
        bins_(continuous_ ? bins_of_turn : step_ * axis.order) {
    const Eigen::Matrix<double, 3, 2> across = orthogonal_to(axis.direction);
    for (const Vector3& x : positions) {
      const Vector3 v = x - axis.point;
      const Eigen::Vector2d flat = across.transpose() * v;
      const double angle = std::atan2(flat.y(), flat.x()) / (2 * std::numbers::pi);
      const auto bin = static_cast<Index>(std::floor(angle * static_cast<double>(bins_)));
      Bins& there = cells_[{static_cast<int>(std::floor(flat.norm() / size)),
                            static_cast<int>(std::floor(axis.direction.dot(v) / size))}];
      there.resize(bins_);
      there[(bin + bins_) % bins_] = true;
    }
    if (continuous_) drop_what_is_narrow();
    for (const auto& [place, there] : cells_) near_.push_back(near(place));
  }

  // In bins; none: 0.
  Index best_turn() const {
    std::vector<Index> gains;
    for (Index turn = 0; turn < bins_; turn += step_) gains.push_back(gain(turn));
    const auto count = static_cast<Index>(gains.size());
    const auto at = [&](Index k) { return static_cast<double>(gains[(k + count) % count]); };
    const auto most = static_cast<double>(*std::max_element(gains.begin(), gains.end()));
    if (!(most > next_to_nothing * static_cast<double>(there()))) return 0;
    Index best = 0;
    for (Index k = 1; k <= count / 2 && best == 0; ++k)
      for (const Index signed_k : {k, -k})
        if (best == 0 && at(signed_k) >= as_good * most) best = signed_k;
    if (continuous_) {
      // What closes the gap laps over both of its sides, what does not over one.
      const bool closes = most >= nearly_all * static_cast<double>(missing());
      const Index moved = best + (closes == (best > 0) ? overlap : -overlap);
      if (at(moved) >= (closes ? as_good : 1 - nearly_all) * most) best = moved;
    }
    return best * step_;
  }

  double radians(Index turn) const {
    return 2 * std::numbers::pi * static_cast<double>(turn) / static_cast<double>(bins_);
  }

 private:
  using Place = std::pair<int, int>;
  using Bins = std::vector<bool>;

  static Index count(const Bins& bins) { return std::count(bins.begin(), bins.end(), true); }

  void drop_what_is_narrow() {
    std::vector<Index> counts;
    for (const auto& [place, there] : cells_) counts.push_back(count(there));
    const double least = least_of_median * static_cast<double>(median(std::move(counts)));
    std::erase_if(
        cells_, [&](const auto& each) { return static_cast<double>(count(each.second)) < least; });
  }

  // Where a cell or one of those that touch it has surface: a profile along their edge is in
  // either.
  Bins near(const Place& place) const {
    Bins any(bins_);
    for (int i = -1; i <= 1; ++i)
      for (int j = -1; j <= 1; ++j) {
        const auto found = cells_.find({place.first + i, place.second + j});
        if (found == cells_.end()) continue;
        for (Index b = 0; b < bins_; ++b)
          if (found->second[b]) any[b] = any[(b + 1) % bins_] = any[(b + bins_ - 1) % bins_] = true;
      }
    return any;
  }

  Index gain(Index turn) const {
    Index sum = 0;
    auto taken = near_.begin();
    for (const auto& [place, there] : cells_) {
      for (Index b = 0; b < bins_; ++b) sum += there[b] && !(*taken)[(b + turn) % bins_];
      ++taken;
    }
    return sum;
  }

  Index there() const {
    Index sum = 0;
    for (const auto& [place, bins] : cells_) sum += count(bins);
    return sum;
  }

  Index missing() const {
    Index sum = 0;
    for (const Bins& taken : near_) sum += bins_ - count(taken);
    return sum;
  }

  bool continuous_;
  Index step_, bins_;
  std::map<Place, Bins> cells_;
  std::vector<Bins> near_;  // one a cell
};

std::vector<Parameter> axis_parameters() {
  return {
      Parameter::choice(
          "symmetry", "mirror", {"mirror", "axis"},
          "Symmetry of the shape: its mirror, or rotations about an axis, which need no mirror."),
      Parameter::position("axis_point", "A point on the axis, input units."),
      Parameter::direction("axis_direction",
                           "Direction of the axis; (0, 0, 0): the axis is found."),
      Parameter::integer("axis_order", 0, 0, highest_order, "",
                         "A rotation by 360 degrees / axis_order maps the shape onto itself; 0: "
                         "any rotation does. If the axis is found, so is its order.")};
}

// The axis that the parameters give, or the main one of the shape where they give none. Throws
// InvalidParameter where they make no axis, InvalidInput where it is far from the points or none is
// found.
SymmetryAxis axis_of(const OperationInput& input, const ParameterValues& values,
                     const Context& context) {
  constexpr double farthest = 10;  // diagonals, as of mirrors
  SymmetryAxis axis{values.vector("axis_point"), values.vector("axis_direction"),
                    values.integer("axis_order")};
  if (axis.order == 1)
    throw InvalidParameter("axis_order is 1; allowed is 0 for any turn, or [2, " +
                           std::to_string(highest_order) + "]");
  if (axis.direction.isZero(0)) {
    if (!axis.point.isZero(0) || axis.order != 0)
      throw InvalidParameter(
          std::string(axis.order != 0 ? "axis_order" : "axis_point") +
          " is given without axis_direction; allowed is both, or neither for the axis to be found");
    if (const auto found = find_axis(input.points, input.faces, context)) return *found;
    throw InvalidInput("the shape has no rotation axis; give axis_point and axis_direction");
  }
  axis.direction.stableNormalize();
  const Vector3 middle = input.points.matrix().colwise().mean().transpose();
  axis.point += (middle - axis.point).dot(axis.direction) * axis.direction;
  const double distance = (middle - axis.point).norm(), diagonal = diagonal_of(input.points);
  if (!(distance <= farthest * diagonal))
    throw InvalidInput(
        "the points lie " + to_string(Value(distance / diagonal)) +
        " diagonals away from this axis; the axis must be in the unit and pose of the points");
  return axis;
}

// The least turn about the axis, in radians, of those that lay most of the shape where the turned
// shape has nothing: few fill what it lacks. None where it lacks next to nothing.
std::optional<double> covering_turn(PointsView points, TrianglesView faces,
                                    const SymmetryAxis& axis, const Context& context) {
  Cloud cloud(points);
  cloud.faces = faces;
  SurfaceSamples samples;
  if (!faces.empty()) samples.apply(cloud, context);
  validate(cloud, 1, context);
  const Surfels& surfels =
      cloud.patches(std::min(surfels_wanted, cloud.points.size() / 2), context);
  std::vector<Vector3> positions;
  for (Index i = 0; i < surfels.size(); ++i)
    positions.push_back(cloud.frame.from_frame(surfels[i].position));
  const Coverage coverage(positions, axis, cell * cloud.diagonal);
  const Index turn = coverage.best_turn();
  if (turn == 0) return {};
  return coverage.radians(turn);
}

void run_about_axis(const OperationInput& input, const ParameterValues& values,
                    const Context& context, OperationResult& result) {
  constexpr Index most_turns = 16;
  if (!values.boolean("search"))
    throw InvalidParameter("search is false beside the symmetry axis; allowed is true");
  const SymmetryAxis axis = axis_of(input, values, context.stage(0, 0.4));
  start_completion(input, result);
  Index turns = 0;
  for (double left = 0.6; turns < most_turns; ++turns, left /= 2) {
    const Context rest = context.stage(1 - left, 1 - left / 2);
    const std::optional<double> angle = covering_turn(result.points, result.faces, axis, rest);
    if (!angle) break;
    // What the shape turned back does not reach is what the turned shape adds.
    const Matrix3 back = Eigen::AngleAxisd(-*angle, axis.direction).toRotationMatrix();
    const Index before = result.points.rows();
    complete_by(SymmetryMap(map_taking(back, axis.point, axis.point)), values, rest, result);
    if (result.points.rows() == before) break;
  }
  for (const char* name : {"added_points", "added_faces", "seam_faces"})
    result.statistics.try_emplace(name, Index{0});
  result.statistics["turns"] = turns;
  result.statistics["axis_point"] = axis.point;
  result.statistics["axis_direction"] = axis.direction;
  result.statistics["axis_order"] = axis.order;
}

}  // namespace

OperationImplementation also_about_axis(OperationImplementation completion) {
  for (const Parameter& parameter : axis_parameters()) completion.parameters.push_back(parameter);
  completion.run_about_axis = run_about_axis;
  return completion;
}

}  // namespace symsurf
