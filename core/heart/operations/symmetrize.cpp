#include <cmath>
#include <optional>

#include "base/parallel.h"
#include "operations/counterparts.h"
#include "operations/meshes.h"
#include "operations/operation.h"

namespace symsurf {

namespace {

// Of so many matched points, the vertices mirror each other and are kept together; fewer meet by
// chance, and pairs of them would slide over the surface.
constexpr double vertices_mirror = 0.9, triangles_agree = 0.95;

class Symmetrization {
 public:
  Symmetrization(const Matchers& matchers, const OperationInput& input, const Mirror& mirror,
                 const ParameterValues& values)
      : input_(input),
        mirror_(mirror),
        limits_(limits_of(values, input.points)),
        matcher_(pairing_of(values, matchers)),
        vertex_pairs_(matcher_ ? nullptr : matchers.vertex_pairs),
        on_mirror_(mirror_tolerance * diagonal_of(input.points)) {}

  // Each point halfway to its place.
  Points average(const Context& context) {
    return moved(
        input_.points, context,
        [](const Vector3& x, const Vector3& place, double) -> Vector3 { return (x + place) / 2; });
  }

  // The points of the other side carried to the image of this one.
  Points carried(const Points& from, bool positive, const Context& context) {
    return moved(from, context, [&](const Vector3& x, const Vector3& place, double distance) {
      return (distance > 0) == positive ? x : place;
    });
  }

  /// 1 where a point had a counterpart at first, else 0.
  const Eigen::VectorXd& paired() const { return paired_; }

  /// What Counterparts::report() said at first.
  const Values& unmatched() const { return unmatched_; }

 private:
  static constexpr Index grain = 512;  // points; ten microseconds each over a free-form mirror

  static bool is_mutual(const Counterparts& found, Index i) {
    const Counterpart& partner = found[found[i].nearest];
    return partner.matched && partner.nearest == i;
  }

  bool mirrors_vertices(const Counterparts& found) const {
    Index mutual = 0;
    for (Index i = 0; i < input_.points.size(); ++i)
      mutual += found[i].matched && is_mutual(found, i);
    return static_cast<double>(mutual) >= vertices_mirror * static_cast<double>(found.matched());
  }

  // Whether the triangles tell nearly all of the pairs that were found without them.
  bool agree(const Counterparts& asked, const Counterparts& told) const {
    Index pairs = 0, same = 0;
    for (Index i = 0; i < input_.points.size(); ++i) {
      if (!asked[i].matched || !is_mutual(asked, i)) continue;
      ++pairs;
      same += told[i].nearest == asked[i].nearest;
    }
    return static_cast<double>(same) >= triangles_agree * static_cast<double>(pairs);
  }

  // What has a counterpart comes to to(x, place, signed distance); what lies on the mirror, to its
  // foot.
  template <typename To>
  Points moved(PointsView from, const Context& context, const To& to) {
    OperationInput input = input_;
    input.points = from;
    const Counterparts asked(input, mirror_, limits_, context.stage(0, 0.4), matcher_);
    const bool keep_pairs = mirrors_vertices(asked);
    // The triangles tell the others, however far one side was moved.
    std::optional<Counterparts> told;
    if (keep_pairs && vertex_pairs_) {
      told.emplace(input, mirror_, limits_, context.stage(0.4, 0.8), vertex_pairs_);
      if (!mirrors_vertices(*told) || !agree(asked, *told)) told.reset();
      // Points move, triangles do not.
      if (told) matcher_ = [pairs = *told->homologous()](const auto&...) { return pairs; };
      vertex_pairs_ = nullptr;
    }
    const Counterparts& found = told ? *told : asked;
    if (paired_.size() == 0) {
      paired_ = Eigen::VectorXd::NullaryExpr(from.size(),
                                             [&](Index i) { return found[i].matched ? 1 : 0; });
      found.report(unmatched_);
    }
    Points points = from.matrix();
    parallel_for(context.stage(0.8, 1), from.size(), grain, [&](Index begin, Index end) {
      for (Index i = begin; i < end; ++i) {
        const Counterpart& c = found[i];
        // What has none at first stays, also where the average of others comes near to its image.
        if (!c.matched || paired_[i] == 0) continue;
        const Vector3 x = from[i];
        const bool lies_on_mirror =
            std::abs(found.signed_distance(i)) <= on_mirror_ || c.nearest == i;
        const bool is_pair = keep_pairs && is_mutual(found, i);
        points.row(i) = (lies_on_mirror ? mirror_.foot(x)
                                        : to(x, is_pair ? found.image(c.nearest) : c.place,
                                             found.signed_distance(i)))
                            .transpose();
      }
    });
    return points;
  }

  const OperationInput& input_;
  const Mirror& mirror_;
  const Counterparts::Limits limits_;
  HomologousMatcher matcher_, vertex_pairs_;  // null: the closest points
  double on_mirror_;
  Eigen::VectorXd paired_;
  Values unmatched_;
};

// Of the same points and faces.
void move_points(const Matchers& matchers, const OperationInput& input, const Mirror& mirror,
                 const ParameterValues& values, const Context& context, OperationResult& result) {
  Symmetrization symmetrization(matchers, input, mirror, values);
  const std::string& side = values.choice("side");
  Points target;
  if (side == "average") {
    // What lies between the points of the other side comes to lie on their average's image.
    target = symmetrization.average(context.stage(0, 0.5));
    target = symmetrization.carried(target, true, context.stage(0.5, 1));
  } else {
    target = symmetrization.carried(result.points, side == "positive", context);
  }
  const double strength = values.real("strength");
  for (Index i = 0; i < target.rows(); ++i) {
    const double share = strength * (input.mask.size() > 0 ? input.mask[i] : 1);
    if (share == 1)
      result.points.row(i) = target.row(i);
    else if (share > 0)
      result.points.row(i) += share * (target.row(i) - result.points.row(i));
  }
  result.arrays = {{"paired", symmetrization.paired()}};
  result.statistics = symmetrization.unmatched();
  result.statistics["paired_share"] = symmetrization.paired().mean();
}

// Of one side and its image, whose vertices are exact partners.
void mirror_triangles(const Matchers& matchers, const OperationInput& input, const Mirror& mirror,
                      const ParameterValues& values, const Context& context,
                      OperationResult& result) {
  if (values.real("strength") != 1 || input.mask.size() > 0)
    throw InvalidParameter(
        "triangles is mirrored, with a strength below 1 or a mask; allowed with these is kept");
  const std::string& side = values.choice("side");
  Points points = input.points.matrix();
  if (side == "average") {
    Symmetrization symmetrization(matchers, input, mirror, values);
    points = symmetrization.average(context.stage(0, 0.7));
    result.statistics = symmetrization.unmatched();
  }
  Half half = half_of(points, input.faces, mirror, side != "negative", context.stage(0.7, 0.8));
  MirroredHalf made = with_image(std::move(half), mirror, context.stage(0.8, 1));
  result.arrays = {{"paired", Eigen::VectorXd::Ones(made.points.rows())}};
  set_shape(std::move(made), result);
  result.statistics["paired_share"] = 1.0;
}

void run_symmetrize(const Matchers& matchers, const OperationInput& input, const Mirror& mirror,
                    const ParameterValues& values, const Context& context,
                    OperationResult& result) {
  const bool mirrored = values.choice("triangles") == "mirrored";
  (mirrored ? mirror_triangles : move_points)(matchers, input, mirror, values, context, result);
}

}  // namespace

OperationImplementation symmetrize_operation(const Matchers& matchers) {
  OperationImplementation operation;
  operation.name = "symmetrize";
  operation.title = "Mirror symmetrization";
  operation.summary =
      "Moves the points so that the shape becomes symmetric: both sides to their average, or one "
      "side onto the image of the other.";
  operation.parameters = {
      Parameter::choice("side", "average", {"average", "positive", "negative"},
                        "Shape of both sides: their average, or the side where the signed distance "
                        "from the mirror is positive or negative."),
      Parameter::choice("triangles", "kept", {"kept", "mirrored"},
                        "kept: the points and triangles of the shape, moved; mirrored: those of "
                        "one side, cut along the mirror, and their images, exactly symmetric. With "
                        "the average that is the positive side."),
      Parameter::real("strength", 1, 0, 1, "",
                      "How far the points move: 0 not at all, 1 all the way."),
      pairing(),
      max_distance(),
      max_angle()};
  operation.arrays = {
      {"paired", ParameterType::Boolean, 1,
       "Whether the point has a counterpart; otherwise it does not move."},
      {"partner", ParameterType::Integer, 1,
       "With mirrored triangles: index of the point that is its image, its own on the mirror.",
       false, true}};
  operation.moves_points = true;
  operation.makes_shape = true;
  operation.takes_mask = true;
  operation.shown = "paired";
  operation.run = std::bind_front(run_symmetrize, matchers);
  return operation;
}

}  // namespace symsurf
