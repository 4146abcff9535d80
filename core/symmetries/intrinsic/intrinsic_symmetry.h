#pragma once

#include <symsurf/context.h>
#include <symsurf/points.h>

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "cloud/laplacian.h"
#include "cloud/point_tree.h"

namespace symsurf {

/// A connected surface of distinct points, as a mesh or a cloud gives it, with its Laplacian.
struct ConnectedSurface {
  Points points;
  Laplacian laplacian;  ///< areas add up to 1, eigenvalues are in their unit
  Index parts = 0;      ///< of the input that do not touch
  double share = 0;     ///< of the area of all in this one
};

/// The part of the input that has the most area. Equal points are merged, parts joined where they
/// are about as near each other as neighbouring vertices; without faces the points are a cloud.
/// Throws InvalidInput where nothing has an area.
ConnectedSurface connected_surface(PointsView points, TrianglesView faces, const Context& context);

/// Lengths of the shortest ways along edges of the Laplacian from a vertex to all (Dijkstra 1959).
Eigen::VectorXd edge_distances(const ConnectedSurface& surface, Index from);

/// The first eigenfunctions of the Laplacian of a surface, but for the constant one.
struct SurfaceBasis {
  Eigen::VectorXd values;     ///< ascending, times the area of the surface
  Eigen::MatrixXd functions;  ///< one a column, their squares 1 in the mean
  Index count() const { return values.size(); }
};

SurfaceBasis surface_basis(const ConnectedSurface& surface, Index count, const Context& context);

/// Removes the links of a cloud's surface along which eigenfunctions rise much more steeply than
/// elsewhere, as where a hand touches a leg: ways along the surface no longer lead through there.
/// Those that hold it together stay.
void part_contacts(const SurfaceBasis& basis, ConnectedSurface& surface);

/// Vertices far from each other, to compare maps at.
struct SampledPoints {
  std::vector<Index> vertices;
  Eigen::VectorXd weights;     ///< the area nearest to each along edges; their sum is 1
  Eigen::MatrixXd distances;   ///< between them along edges, in the longest of these
  Eigen::MatrixXd to_all;      ///< the same to all vertices, a row a vertex
  std::vector<Index> nearest;  ///< of each vertex the nearest, by its position among them

  double longest = 0;  ///< in the unit of the surface

  Index count() const { return weights.size(); }
};

SampledPoints surface_samples(const ConnectedSurface& surface, Index count, const Context& context);

/// How a map changes patches of a surface.
struct PatchChange {
  double bending = 0;     ///< mean distance from reflected samples to their images, in patch sizes
  double handedness = 0;  ///< 1: reflections fit patches, -1: rotations do; 0: both as well
};

/// Patches about samples of a posed body. A pose keeps each about rigid, so that a reflection takes
/// it to its image: that sets right, and says between the samples, what eigenfunctions give
/// roughly (as rigid as possible: Sorkine and Alexa 2007). Refers to what it is made of.
class Patches {
 public:
  Patches(const ConnectedSurface& surface, const SampledPoints& samples, const PointTree& vertices,
          double radius);

  /// Of the map that sends the samples to these vertices.
  PatchChange change(const std::vector<Index>& images) const;

  /// The images of the samples, after so many rounds of patches reflected to their images and of
  /// samples moved to where these reflections send them.
  std::vector<Index> refined(std::vector<Index> images, int rounds) const;

  /// The map for points of space: a point beside a vertex goes beside the vertex's image, as the
  /// reflection of its patch says.
  class Extended {
   public:
    Vector3 image(const Vector3& x, Index vertex) const;

   private:
    friend class Patches;
    const Patches* patches_;
    std::vector<Eigen::Isometry3d> reflections_;
    std::vector<Index> images_;  // of all vertices
  };

  Extended extended(const std::vector<Index>& images, const Context& context) const;

 private:
  struct Member {
    Index sample;
    double weight;
  };
  struct Moments;

  static double residual(const Moments& sums, double parity);
  Moments moments(const std::vector<Member>& patch, const std::vector<Index>& images) const;
  std::vector<Eigen::Isometry3d> reflections(const std::vector<Index>& images) const;
  Index image(const std::vector<Eigen::Isometry3d>& reflections, Index vertex) const;

  const ConnectedSurface& surface_;
  const SampledPoints& samples_;
  const PointTree& vertices_;
  std::vector<double> radii_;  // of the patches, in the longest distance
  std::vector<std::vector<Member>> patches_;
};

/// A map of a surface onto itself, by where it sends samples, that keeps its eigenfunctions up to
/// their signs.
struct IntrinsicMap {
  std::vector<Index> images;  ///< vertices
  std::string signs;  ///< "+", "-" of the eigenfunctions that the search began with, "0": left out
  double distortion = 0;  ///< mean difference of distances before and after, in the longest one
  double moved = 0;       ///< mean distance from points to images, in the longest one
  PatchChange change;     ///< of patches about the samples
};

/// Whether a map keeps distances along the surface and the shapes of patches better than another,
/// for how far it moves points.
bool is_better(const IntrinsicMap& one, const IntrinsicMap& other);

/// Sets where the map sends samples, and how well it keeps distances and the patches' shapes.
void set_images(std::vector<Index> images, const SampledPoints& samples, const Patches& patches,
                IntrinsicMap& map);

/// Maps that turn the surface over, the best first, from the signs of the first eigenfunctions
/// (Nagar and Raman 2018: for a symmetry and eigenvalues that differ, the functional map is
/// diagonal, of 1 and -1). All signs of a few functions are tried at samples, and the most
/// promising ones that reverse the orientation refined with ZoomOut and by distances along the
/// surface. None where too few eigenvalues stand alone.
std::vector<IntrinsicMap> search_maps(const SurfaceBasis& basis, const SampledPoints& samples,
                                      const Patches& patches, const Context& context);

}  // namespace symsurf
