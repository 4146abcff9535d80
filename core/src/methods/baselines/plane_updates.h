#pragma once

#include "methods/baselines/plane_iteration.h"

namespace symsurf {

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

}  // namespace symsurf
