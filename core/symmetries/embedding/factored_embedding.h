#pragma once

#include <symsurf/context.h>
#include <symsurf/points.h>

#include <Eigen/Geometry>
#include <limits>
#include <vector>

#include "cloud/point_tree.h"

namespace symsurf {

/// A motion or reflection of a point set, and the root mean square deviation D(X, gX) between the
/// set and its image, both ways, in diameters (Lipman et al. 2010).
struct NearSymmetry {
  Eigen::Isometry3d map;
  double deviation = 0;
};

struct NearSymmetries {
  Vector3 centre = Vector3::Zero();           ///< the centroid
  double diameter = 0;                        ///< twice the largest distance from it
  std::vector<NearSymmetry> maps;             ///< the identity first
  bool exact = false;                         ///< they map points onto others, up to rounding
  std::vector<Eigen::Isometry3d> generators;  ///< of which exact ones are products
};

/// The symmetries of a point set of which each point has its partners: those that map a base of two
/// points to two others of the same distances. Where there are none, motions and reflections with a
/// deviation of at most `tolerance` diameters, fitted to nearest points (ICP).
NearSymmetries near_symmetries(PointsView points, const PointTree& tree, double tolerance,
                               const Context& context);

/// The Symmetry Factored Embedding of a point set (Lipman et al. 2010): points that a symmetry maps
/// onto each other have the same coordinates.
struct FactoredEmbedding {
  std::vector<Index> orbits;    ///< of each point the number of its orbit, by first points
  std::vector<Index> sizes;     ///< points of each orbit
  Eigen::VectorXd eigenvalues;  ///< of the symmetry correspondence matrix, those of the coordinates
  /// A row a point: eigenvalue^power times the eigenvectors there, of as many as were asked for.
  Eigen::MatrixXd coordinates;
};

struct EmbeddingOptions {
  double localization = 0.02;  ///< sigma of the correspondence, in diameters
  double power = 1;            ///< t of the embedding
  double resolution = 0.02;  ///< how near points of one orbit are without exact partners, diameters
  Index coordinates = std::numeric_limits<Index>::max();  ///< at most, of the largest eigenvalues
};

/// The correspondence of x and y is exp(-(S / localization)^2), where S, in diameters, is the least
/// D(X, gX) + |g x - y| of the maps g: an upper bound of Lipman's infimum that symmetries attain.
/// Of more than some thousand orbits, or hundred with many maps, the eigenvectors are those of
/// landmarks, each with the mass of the points nearest to it, carried on to the others by the
/// matrix (Nyström).
FactoredEmbedding factored_embedding(PointsView points, const PointTree& tree,
                                     const NearSymmetries& symmetries,
                                     const EmbeddingOptions& options, const Context& context);

}  // namespace symsurf
