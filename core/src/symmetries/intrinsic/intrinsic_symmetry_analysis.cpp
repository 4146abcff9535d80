#include <symsurf/context.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "base/math.h"
#include "base/parallel.h"
#include "cloud/footprint.h"
#include "preprocess/boundary.h"
#include "symmetries/analysis_registry.h"
#include "symmetries/intrinsic/functional_map.h"
#include "symmetries/thinned_surface.h"

namespace symsurf {

namespace {

constexpr Index samples_searched = 200;  // vertices at which maps are compared
constexpr Index samples_refined = 1000;  // at which the best is refined
constexpr Index functions_refined = 30;  // from which on it is, a few more at a time
constexpr Index functions_a_step = 5;
constexpr Index most_points = 20'000;  // more are thinned to
constexpr Index thinned_points = 10'000;
// Mean change of distances, in how far points are moved: that of scans with holes, mapped rightly,
// was 0.2 at most in some 40 draws, that of fronts mapped to backs 0.27 and more.
constexpr double most_distortion = 0.25;
constexpr double least_confidence = 0.3;  // mean
constexpr double half_confident = 0.02;   // diagonals between a point and the image of its image

// Empty: the map is a symmetry.
std::string reason_against(const IntrinsicMap& map, double confidence) {
  if (map.signs.empty())
    return "too few eigenvalues stand alone, as on a ball, whose symmetries are continuous";
  if (map.map.size() == 0) return "no signs of the eigenfunctions give a map but the identity";
  if (!(map.orientation < 0)) return "no map that reverses the orientation keeps distances";
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
    throw InvalidInput(std::to_string(cloud.points.size()) +
                       " points fill a body; intrinsic_symmetry takes those of its surface, or at "
                       "most " +
                       std::to_string(most));
}

struct Image {
  Index point = -1;
  double confidence = 0;
};

// Of each point of the cloud, carried from the vertices that it was thinned to: the point nearest
// to the mean of the images of those about it. None of a point off them.
std::vector<Image> carried_images(const Cloud& cloud, const ConnectedSurface& surface,
                                  double spacing, const std::vector<Index>& images,
                                  const Eigen::VectorXd& confidence, const Context& context) {
  constexpr Index around = 4, grain = 1024;
  constexpr double farthest = 3, rounding = 0.03;  // spacings
  const PointTree vertices(surface.points, context), points(cloud.points, context);
  std::vector<Image> carried(cloud.points.size());
  parallel_for(context, cloud.points.size(), grain, [&](Index begin, Index end) {
    std::vector<Neighbour> near;
    for (Index i = begin; i < end; ++i) {
      vertices.nearest(cloud.frame.to_frame(cloud.points[i]), around, near);
      if (near.front().squared_distance > farthest * farthest * spacing * spacing) continue;
      Vector3 image = Vector3::Zero();
      double weights = 0, sure = 0;
      for (const Neighbour& n : near) {
        const double weight = 1 / (n.squared_distance + rounding * rounding * spacing * spacing);
        image += weight * surface.points.row(images[n.index]).transpose();
        sure += weight * confidence[n.index];
        weights += weight;
      }
      carried[i] = {points.nearest(cloud.frame.from_frame(image / weights)).index, sure / weights};
    }
  });
  return carried;
}

void run_intrinsic_symmetry(const ColouredCloud& cloud, const ParameterValues& values,
                            const Context& context, AnalysisResult& result) {
  require_surface(cloud, context.stage(0, 0));
  const Index count = values.integer("functions");
  std::optional<ThinnedSurface> thinned;  // in the principal frame
  if (cloud.points.size() > most_points)
    thinned.emplace(cloud, thinned_points, context.stage(0, 0.05));
  const ConnectedSurface surface =
      thinned ? connected_surface(thinned->points().points, {}, context.stage(0.05, 0.1))
              : connected_surface(cloud.points, cloud.faces, context.stage(0, 0.1));
  const double diagonal = thinned ? 1 : cloud.diagonal;
  const SurfaceBasis basis = surface_basis(surface, count, context.stage(0.1, 0.4));
  const SampledPoints samples = surface_samples(surface, samples_searched, context.stage(0.4, 0.5));
  IntrinsicMap found = search_map(surface, basis, samples, context.stage(0.5, 0.8));

  const Index size = surface.points.rows();
  std::vector<Index> images(size, -1);
  Eigen::VectorXd confidence = Eigen::VectorXd::Zero(size);
  if (found.map.size() > 0) {
    const std::vector<Index> dense = farthest_points(surface.points, samples_refined, context);
    const SampledFunctions sampled(basis, dense, surface.laplacian.areas(dense));
    const Index from = std::min(functions_refined, basis.count());
    found.map =
        sampled.refined(sampled.images(found.map), from, basis.count(), functions_a_step, context);
    images = all_images(basis, found.map, context.stage(0.8, 1));
    for (Index v = 0; v < size; ++v) {
      const double back = (surface.points.row(images[images[v]]) - surface.points.row(v)).norm() /
                          (half_confident * diagonal);
      confidence[v] = 1 / (1 + back * back);
    }
  }
  const double mean = surface.laplacian.areas.dot(confidence);
  const std::string reason = reason_against(found, mean);

  std::vector<Image> carried(cloud.points.size());
  if (reason.empty() && thinned)
    carried = carried_images(cloud, surface, thinned->spacing(), images, confidence, context);
  else if (reason.empty())
    for (Index i = 0; i < cloud.points.size(); ++i)
      if (const Index v = surface.vertex_of[i]; v >= 0)
        carried[i] = {surface.point_of[images[v]], confidence[v]};
  Eigen::MatrixXd image(cloud.points.size(), 1), sure(cloud.points.size(), 1);
  for (Index i = 0; i < cloud.points.size(); ++i) {
    image(i) = static_cast<double>(carried[i].point);
    sure(i) = carried[i].confidence;
  }
  result.arrays = {{"image", image}, {"confidence", sure}};
  result.statistics = {{"verdict", std::string(reason.empty() ? "found" : "none")},
                       {"reason", reason},
                       {"signs", found.signs},
                       {"orientation", found.orientation},
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
      "Gives for each point of a posed body the one on its other side, where no mirror maps left "
      "to right.";
  analysis.parameters = {Parameter::integer(
      "functions", 60, 20, 60, "",
      "Eigenfunctions that images are compared by; more follow details, fewer noise less.")};
  analysis.arrays = {
      {"image", ParameterType::Integer, 1, "The point on the other side, -1 for none.", false,
       true},
      {"confidence", ParameterType::Real, 1,
       "0 to 1: halved where the image of the image lies 2 % of the diagonal away."},
  };
  analysis.shown = "confidence";
  analysis.maximum_points = 2'000'000;
  analysis.run = run_intrinsic_symmetry;
  return analysis;
}

}  // namespace symsurf
