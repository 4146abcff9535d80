#pragma once

#include <symsurf/detect.h>
#include <symsurf/parameter.h>
#include <symsurf/points.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "cloud/cloud.h"
#include "cloud/point_tree.h"
#include "cloud/principal_frame.h"
#include "cloud/voxel_grid.h"
#include "search/methods.h"

namespace symsurf {

/// The line through a point along a unit direction, as the thesis's Algorithms 1 to 3 measure from
/// it; `diagonal` is that of the cloud.
struct Line {
  Vector3 start, direction;
  double diagonal;

  double squared_distance(const Vector3& x) const {
    const Vector3 w = x - start, u = direction;
    const double along = w.x() * u.x() + w.y() * u.y() + w.z() * u.z();
    const Vector3 r = w - along * u;
    return r.x() * r.x() + r.y() * r.y() + r.z() * r.z();
  }

  /// The square of how far a tree has to look for what beats `best` or ties with it. A projection
  /// rounds distances by some 1e-15 diagonals, which this allows for many times over.
  double reach(const Neighbour& best) const {
    return best.squared_distance * (1 + 1e-12) + 1e-16 * diagonal * diagonal;
  }
};

/// The result of the thesis's Algorithms 1 to 3: points with their partners, the distances of these
/// from their lines, the midpoints. `partners` by index of the point; -1: has none.
///
/// The score, 0 to 1, is the share of the points that a smooth surface through the midpoints
/// mirrors onto their partners, to within the spacing of the points; points nearer to the surface
/// than that do not count.
Result midpoint_pairs(const Cloud& cloud, const std::vector<Neighbour>& partners,
                      const Context& context);

/// The parameters of Algorithms 2 and 3: how normals are estimated where none are given.
std::vector<Parameter> normal_parameters();

/// Unit normals, the cloud's own or estimated as the parameters say.
Points given_or_estimated_normals(const Cloud& cloud, const ParameterValues& values,
                                  const Context& context);

/// Points in the principal frame and, of each, the one nearest to its image over a plane.
struct Correspondences {
  const Points& points;
  const std::vector<Neighbour>& partner;
};

/// The next plane, from the correspondences over this one.
using PlaneUpdate = std::function<UnitPlane(const Correspondences&, const UnitPlane&)>;

/// The thinned cloud that starts are tried on: positions of about 500 surfels, in the
/// principal frame.
Points thinned_points(const Cloud& cloud, const Context& context);

/// Iterative closest points under a reflection (Besl and McKay 1992), coarse to fine: nearest
/// points, then the update, until the plane rests. From every start on the thinned cloud; the best
/// few planes go on on all points, and the score ranks them.
Result iterated_planes(const std::string& method, const Cloud& cloud, const Points& thinned,
                       const std::vector<UnitPlane>& starts, const PlaneUpdate& update,
                       const ParameterValues& values, const Context& context);

/// The best of the planes by the score, with its pairs; the others are its candidates.
Result ranked_planes(const std::string& method, const Cloud& cloud,
                     const std::vector<std::shared_ptr<Mirror>>& planes,
                     const ParameterValues& values, const Context& context);

/// The parameter "normal" of a start, and the start that it asks for; none where it is zero.
Parameter start_normal(std::string doc);
std::vector<UnitPlane> given_start(const Cloud& cloud, const ParameterValues& values);

/// The plane of Combes et al. (2008) that minimises sum w |S(x) - y|^2 over pairs (x, y), S its
/// reflection, w = exp(-r^2 / (2 s^2)) of the residual r, s from the median one.
///
/// |S(x) - y|^2 = |x - y|^2 + 4 (n . (x - p)) (n . (y - p)) for a plane through p with the normal
/// n. So the plane goes through the weighted mean m of the midpoints, and n is the eigenvector of
/// the least eigenvalue of the symmetric part of sum w (x - m)(y - m)'.
UnitPlane robust_update(const Correspondences& correspondences, const UnitPlane& before);

/// The reflection of Nagar and Raman (2020) over mutual pairs, those of which each is the partner
/// of the other: S = U V' of W = sum (y - c)(x - c)' = U D V', c a point of the plane before; then
/// c moves to the mean of the midpoints, where n . c is the best for that S.
///
/// Each pair counts both ways, so W is symmetric. If one eigenvalue is negative, U V' is I - 2 n n'
/// with its eigenvector n. If none or several are, U V' is no reflection in a plane; that which
/// maximises trace(S W) = trace(W) - 2 n' W n has the eigenvector of the least.
UnitPlane mutual_update(const Correspondences& correspondences, const UnitPlane& before);

/// Wendland's function (1 - u)^5 (8 u^2 + 5 u + 1) of a distance in reaches; 0 from 1 on.
double wendland(double u);

/// Distance from which on it is 0: 2.6 / alpha, alpha = 15 / l_avg, l_avg the mean distance of the
/// points from their centroid.
double measure_reach(PointsView points);

/// A grid over a few hundred points: each voxel lists those within reach of some position in it.
class NearbyPoints {
 public:
  NearbyPoints(PointsView points, double reach);

  /// Null where there are none.
  const std::vector<Vector3>* operator()(const Vector3& x) const {
    const Index voxel = grid_.index_at(x);
    return voxel < 0 || lists_[voxel].empty() ? nullptr : &lists_[voxel];
  }

 private:
  VoxelGrid grid_;
  std::vector<std::vector<Vector3>> lists_;  // by voxel
};

/// The symmetry measure of Hruda et al. (2022): s(p) = sum_ij phi(|r(p, x_i) - x_j|), where r(p, x)
/// reflects x over the plane p = (a, b, c, d), (a, b, c) of any length but 0, and phi is Wendland's
/// function.
class SymmetryMeasure {
 public:
  explicit SymmetryMeasure(const Points& points)
      : points_(points), reach_(measure_reach(points)), nearby_(points, reach_) {}

  double operator()(const Eigen::Vector4d& p) const;
  double operator()(const Eigen::Vector4d& p, Eigen::Vector4d& gradient) const;

 private:
  Points points_;
  double reach_;
  NearbyPoints nearby_;
};

}  // namespace symsurf

// Methods as their authors describe them: those of the thesis, and baselines.

namespace symsurf {

MethodImplementation separation_method();
MethodImplementation separation_normals_method();
MethodImplementation normals_only_method();
MethodImplementation sphere_thesis_method();
MethodImplementation plane_icp_method();
MethodImplementation plane_svd_method();
MethodImplementation plane_hruda_method();

}  // namespace symsurf
