#pragma once

#include <symsurf/context.h>
#include <symsurf/points.h>

#include <Eigen/SparseCore>
#include <cstdint>

#include "base/eigenvectors.h"

namespace symsurf {

/// At most `count` least eigenvalues, ascending, with their vectors of A v = lambda M v, v' M v =
/// 1, for a semidefinite A and positive masses: implicitly restarted Lanczos steps on the inverse
/// of A - shift M (Spectra). The shift is negative and small beside the eigenvalues that matter.
SymmetricEigen<Eigen::Dynamic> least_eigenpairs(const Eigen::SparseMatrix<double>& semidefinite,
                                                const Eigen::VectorXd& masses, Index count,
                                                double shift, const Context& context);

/// At most `count` greatest eigenvalues, descending, of a symmetric matrix with their unit vectors,
/// by the same steps.
SymmetricEigen<Eigen::Dynamic> greatest_eigenpairs(
    const Eigen::SparseMatrix<double, Eigen::RowMajor, std::int32_t>& symmetric, Index count,
    const Context& context);

}  // namespace symsurf
