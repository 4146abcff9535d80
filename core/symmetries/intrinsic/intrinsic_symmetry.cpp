#include "intrinsic/intrinsic_symmetry.h"

#include <symsurf/context.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "analysis.h"
#include "base/math.h"
#include "base/parallel.h"
#include "cloud/point_tree.h"
#include "preprocess/boundary.h"
#include "thinned_surface.h"

namespace symsurf {

namespace {

constexpr Index samples_compared = 200;  // vertices at which maps are compared
// Radii of patches in longest distances along the surface: of those that maps are chosen by, about
// a limb, and of those that the best is refined by. Half and twice as much change few draws.
constexpr double wide = 0.25, narrow = 0.12;
constexpr int patch_rounds = 5;        // of each; maps settle in three to five
constexpr Index most_points = 20'000;  // more are thinned to
constexpr Index thinned_points = 10'000;
// Mean change of distances, in how far points are moved: that of scans with holes, mapped rightly,
// was 0.2 at most in some 40 draws, that of fronts mapped to backs 0.27 and more.
constexpr double most_distortion = 0.25;
constexpr double least_confidence = 0.3;  // mean
constexpr double half_confident = 0.02;   // diagonals between a point and the image of its image

// Empty: the map is a symmetry.
std::string reason_against(const IntrinsicMap& map, double confidence) {
  if (map.images.empty())
    return "too few eigenvalues stand alone, as on a ball, whose symmetries are continuous, or no "
           "signs of eigenfunctions turn the surface over";
  if (!is_better(map, {})) return "no map but the identity turns the surface over";
  if (map.distortion > most_distortion * map.moved)
    return "the best map changes distances too much for how far it moves points";
  if (confidence < least_confidence) return "the image of a point's image is not the point";
  return "";
}

// The neighbours of points inside a body are no surface; of many the decomposition of their
// Laplacian fills the memory.
void require_surface(const Cloud& cloud, const Context& context) {
  constexpr Index most = 100'000;
  if (cloud.faces.empty() && cloud.points.size() > most && is_volumetric(cloud, context))
    throw InvalidInput(
        std::to_string(cloud.points.size()) +
        " points fill a body; intrinsic_symmetry takes those of its surface, or at most " +
        std::to_string(most));
}

// Of each point of the cloud the one nearest to where a map of its surface sends it: of parts that
// do not touch the surface too, if they lie in reach of its patches; -1 of others.
std::vector<Index> images_of(const Cloud& cloud, bool in_frame, const PointTree& vertices,
                             const Patches::Extended& map, double reach, const Context& context) {
  constexpr Index grain = 1024;
  const PointTree& points = cloud.tree(context);
  std::vector<Index> images(cloud.points.size(), -1);
  parallel_for(context, cloud.points.size(), grain, [&](Index begin, Index end) {
    for (Index i = begin; i < end; ++i) {
      const Vector3 x = in_frame ? cloud.frame.to_frame(cloud.points[i]) : cloud.points[i];
      const Neighbour vertex = vertices.nearest(x, reach * reach);
      if (vertex.index < 0) continue;
      const Vector3 image = map.image(x, vertex.index);
      images[i] = points.nearest(in_frame ? cloud.frame.from_frame(image) : image).index;
    }
  });
  return images;
}

void run_intrinsic_symmetry(const ColouredCloud& cloud, const ParameterValues& values,
                            const Context& context, AnalysisResult& result) {
  require_surface(cloud, context.stage(0, 0));
  const Index count = values.integer("functions");
  std::optional<ThinnedSurface> thinned;  // in the principal frame
  if (cloud.points.size() > most_points)
    thinned.emplace(cloud, thinned_points, context.stage(0, 0.05));
  ConnectedSurface surface =
      thinned ? connected_surface(thinned->points().points, {}, context.stage(0.05, 0.1))
              : connected_surface(cloud.points, cloud.faces, context.stage(0, 0.1));
  const SurfaceBasis basis = surface_basis(surface, count, context.stage(0.1, 0.4));
  if (thinned || cloud.faces.empty()) part_contacts(basis, surface);
  const SampledPoints samples = surface_samples(surface, samples_compared, context.stage(0.4, 0.5));
  const PointTree vertices(surface.points, context);
  const Patches patches(surface, samples, vertices, wide);
  IntrinsicMap found;
  for (IntrinsicMap& map : search_maps(basis, samples, patches, context.stage(0.5, 0.8))) {
    context.check();
    set_images(patches.refined(std::move(map.images), patch_rounds), samples, patches, map);
    if (found.images.empty() || is_better(map, found)) found = std::move(map);
  }

  std::vector<Index> images(cloud.points.size(), -1);
  if (!found.images.empty()) {
    const Patches last(surface, samples, vertices, narrow);
    images =
        images_of(cloud, thinned.has_value(), vertices,
                  last.extended(last.refined(found.images, patch_rounds), context.stage(0.8, 0.9)),
                  wide * samples.longest, context.stage(0.9, 1));
  }
  Eigen::MatrixXd confidence = Eigen::MatrixXd::Zero(cloud.points.size(), 1);
  Index mapped = 0;
  for (Index i = 0; i < cloud.points.size(); ++i) {
    if (images[i] < 0) continue;
    ++mapped;
    const Index back = images[images[i]];
    if (back < 0) continue;
    const double away =
        (cloud.points[back] - cloud.points[i]).norm() / (half_confident * cloud.diagonal);
    confidence(i) = 1 / (1 + away * away);
  }
  const double mean = mapped > 0 ? confidence.sum() / static_cast<double>(mapped) : 0;
  const std::string reason = reason_against(found, mean);
  Eigen::MatrixXd image = Eigen::MatrixXd::Constant(cloud.points.size(), 1, -1);
  if (reason.empty())
    for (Index i = 0; i < cloud.points.size(); ++i) image(i) = static_cast<double>(images[i]);
  else
    confidence.setZero();
  result.arrays = {{"image", image}, {"confidence", confidence}};
  result.statistics = {{"verdict", std::string(reason.empty() ? "found" : "none")},
                       {"reason", reason},
                       {"signs", found.signs},
                       {"orientation", -found.change.handedness},
                       {"distortion", found.distortion},
                       {"moved", found.moved},
                       {"confidence", mean},
                       {"parts", surface.parts},
                       {"share", surface.share}};
}

}  // namespace

AnalysisImplementation intrinsic_symmetry_analysis() {
  AnalysisImplementation analysis;
  analysis.name = "intrinsic_symmetry";
  analysis.title = "Intrinsic symmetry";
  analysis.summary =
      "Finds for each point of a posed body its counterpart on the other side, even if no mirror "
      "maps left to right.";
  analysis.parameters = {
      Parameter::integer("functions", 40, 20, 60, "",
                         "Number of eigenfunctions used by the search; more follow finer details, "
                         "fewer are more robust to noise.")};
  analysis.arrays = {
      {"image", ParameterType::Integer, 1, "Index of the point on the other side, -1 for none.",
       false, true},
      {"confidence", ParameterType::Real, 1,
       "0 to 1: halved if the image of the image lies 2 % of the diagonal away from the point."},
  };
  analysis.shown = "confidence";
  analysis.maximum_points = 2'000'000;
  analysis.run = run_intrinsic_symmetry;
  return analysis;
}

}  // namespace symsurf
