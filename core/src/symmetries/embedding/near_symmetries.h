#pragma once

#include <symsurf/context.h>
#include <symsurf/points_view.h>

#include <Eigen/Geometry>
#include <vector>

#include "spatial/point_tree.h"

namespace symsurf {

/// A motion or reflection of a point set, and the root mean square deviation D(X, gX) between the
/// set and its image, both ways, in diameters (Lipman et al. 2010).
struct NearSymmetry {
  Eigen::Isometry3d map;
  double deviation = 0;
};

struct NearSymmetries {
  Vector3 centre = Vector3::Zero();  ///< the centroid
  double diameter = 0;               ///< twice the largest distance from it
  std::vector<NearSymmetry> maps;    ///< the identity first
  bool exact = false;                ///< they map points onto others, up to rounding
};

/// The symmetries of a point set of which each point has its partners: those that map a base of two
/// points to two others of the same distances. Where there are none, motions and reflections with a
/// deviation of at most `tolerance` diameters, fitted to nearest points (ICP).
NearSymmetries near_symmetries(PointsView points, const PointTree& tree, double tolerance,
                               const Context& context);

}  // namespace symsurf
