#pragma once

#include <symsurf/types.h>

namespace symsurf {

/// The orthogonal map Q with the greatest trace(Q' products), a rotation for a parity of 1, with a
/// reflection for -1. Of products sum y x' it takes points x nearest to points y (Umeyama 1991).
Matrix3 nearest_orthogonal(const Matrix3& products, double parity);

}  // namespace symsurf
