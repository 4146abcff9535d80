#include "base/sparse_eigen.h"

#include <Spectra/SymEigsShiftSolver.h>

#include <Eigen/SparseCholesky>
#include <algorithm>

namespace symsurf {

namespace {

// y = (A - shift)^-1 x by a Cholesky decomposition without square roots, for Spectra.
class ShiftedInverse {
 public:
  using Scalar = double;

  ShiftedInverse(const Eigen::SparseMatrix<double>& matrix, const Context& context)
      : matrix_(matrix), context_(context) {}

  Eigen::Index rows() const { return matrix_.rows(); }
  Eigen::Index cols() const { return matrix_.cols(); }

  void set_shift(double shift) {
    solver_.setShift(-shift);
    solver_.compute(matrix_);
  }

  void perform_op(const double* x, double* y) const {
    context_.check();
    Eigen::Map<Eigen::VectorXd>(y, rows()) =
        solver_.solve(Eigen::Map<const Eigen::VectorXd>(x, cols()));
  }

 private:
  const Eigen::SparseMatrix<double>& matrix_;
  const Context& context_;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver_;
};

}  // namespace

SymmetricEigen<Eigen::Dynamic> least_eigenpairs(const Eigen::SparseMatrix<double>& semidefinite,
                                                const Eigen::VectorXd& masses, Index count,
                                                double shift, const Context& context) {
  const Index size = semidefinite.rows();
  const Index few = 4 * count;  // of which Lanczos steps gain nothing
  if (size <= few) {
    SymmetricEigen<Eigen::Dynamic> all =
        eigen_of(Eigen::MatrixXd(semidefinite), Eigen::MatrixXd(masses.asDiagonal()));
    const Index kept = std::min(count, size);
    return {all.values.head(kept), all.vectors.leftCols(kept)};
  }
  const Eigen::VectorXd scale = masses.cwiseSqrt().cwiseInverse();
  const Eigen::SparseMatrix<double> scaled = scale.asDiagonal() * semidefinite * scale.asDiagonal();
  ShiftedInverse inverse(scaled, context);
  const Index basis = std::min(size, 2 * count + 20);
  Spectra::SymEigsShiftSolver<ShiftedInverse> solver(inverse, count, basis, shift);
  solver.init();
  constexpr Index restarts = 1000;
  constexpr double tolerance = 1e-10;
  solver.compute(Spectra::SortRule::LargestMagn, restarts, tolerance,
                 Spectra::SortRule::SmallestAlge);
  return {solver.eigenvalues(), scale.asDiagonal() * solver.eigenvectors()};
}

}  // namespace symsurf
