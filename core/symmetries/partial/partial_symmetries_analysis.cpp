#include <cmath>
#include <numbers>

#include "analysis_registry.h"
#include "base/math.h"
#include "partial/partial_search.h"

namespace symsurf {

namespace {

// Radians and diagonals: what a fitted map may miss the symmetry by that it is named after.
constexpr double same_angle = 0.02, same_length = 0.01;

void run_partial_symmetries(const ColouredCloud& cloud, const ParameterValues& values,
                            const Context& context, AnalysisResult& result) {
  const ThinnedSurface surface(cloud, values.integer("points"), context.stage(0, 0.2));
  PartialSearchOptions options;
  options.votes.reflections = values.boolean("reflections");
  options.votes.motions = values.boolean("motions");
  options.votes.scales = values.boolean("scales");
  options.votes.radius = std::sqrt(values.real("disc") * surface.area() / std::numbers::pi);
  options.minimum_size = values.real("minimum_size");
  options.minimum_score = values.real("minimum_score");
  options.count = values.integer("count");
  const std::vector<PatchPair> found = partial_patches(surface, options, context.stage(0.2, 1));

  const Index count = cloud.points.size();
  Eigen::VectorXd best = Eigen::VectorXd::Constant(count, -1), side = best;
  for (const PatchPair& pair : found) {
    Transformation transformation;
    transformation.matrix = surface.in_input_units(pair.map);
    transformation.kind = kind_of(transformation.matrix, cloud.frame.centroid, same_angle,
                                  same_length * cloud.diagonal);
    transformation.score = pair.score;
    transformation.from = surface.near(pair.from);
    transformation.onto = surface.near(pair.onto);
    // Of a coarse mesh, whose surface is sampled, a patch may lie between the points.
    if (transformation.from.empty() || transformation.onto.empty()) continue;
    const auto number = static_cast<double>(result.transformations.size());
    const auto mark = [&](const std::vector<Index>& patch, double which) {
      for (const Index i : patch)
        if (best[i] < 0) {
          best[i] = number;
          side[i] = which;
        }
    };
    mark(transformation.from, 0);
    mark(transformation.onto, 1);
    result.transformations.push_back(std::move(transformation));
  }
  result.arrays = {{"transformation", best}, {"side", side}};
  result.statistics["transformations"] = static_cast<Index>(result.transformations.size());
  result.statistics["diagonal"] = cloud.diagonal;
}

}  // namespace

AnalysisImplementation partial_symmetries_analysis() {
  AnalysisImplementation analysis;
  analysis.name = "partial_symmetries";
  analysis.title = "Partial symmetries";
  analysis.summary =
      "Finds parts of a shape that a reflection, motion or similarity maps onto other parts, by "
      "pairs of like points that vote for it (Mitra et al. 2006).";
  analysis.parameters = {
      Parameter::boolean("reflections", true, "Whether maps may reflect."),
      Parameter::boolean("motions", true, "Whether maps may be rotations, translations, screws."),
      Parameter::boolean("scales", false, "Whether maps may scale, from a half to double."),
      Parameter::real("minimum_size", 0.03, 0.001, 1, "",
                      "The least share of the surface that a patch covers."),
      Parameter::real("minimum_score", 0.8, 0, 1, "",
                      "How close to the surface the images of a patch must come."),
      Parameter::integer("count", 100, 1, 1000, "", "The most transformations that are found."),
      Parameter::real("disc", 0.015, 0.001, 0.1, "",
                      "The share of the surface in the disc that a point is known by."),
      Parameter::integer("points", 10000, 500, 200000, "points",
                         "What a larger cloud is thinned to."),
  };
  analysis.arrays = {
      {"transformation", ParameterType::Integer, 1,
       "The first transformation with the point in a patch, -1: none."},
      {"side", ParameterType::Integer, 1,
       "0: in the patch that is mapped, 1: in the one it falls on, -1: in none."},
  };
  analysis.shown = "transformation";
  analysis.minimum_points = 10;
  analysis.finds_transforms = true;
  analysis.run = run_partial_symmetries;
  return analysis;
}

}  // namespace symsurf
