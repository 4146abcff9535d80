#include "base/sparse_eigen.h"

#include <Spectra/SymEigsShiftSolver.h>
#include <Spectra/SymEigsSolver.h>

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

using Rows = Eigen::SparseMatrix<double, Eigen::RowMajor, std::int32_t>;

// y = A x, for Spectra.
struct Product {
  using Scalar = double;
  const Rows& matrix;
  const Context& context;

  Eigen::Index rows() const { return matrix.rows(); }
  Eigen::Index cols() const { return matrix.cols(); }

  void perform_op(const double* x, double* y) const {
    context.check();
    Eigen::Map<Eigen::VectorXd>(y, rows()) = matrix * Eigen::Map<const Eigen::VectorXd>(x, cols());
  }
};

constexpr Index gained_from = 4;  // times as many rows as eigenpairs: of fewer all are found
constexpr Index restarts = 1000;
constexpr double tolerance = 1e-10;

Index lanczos_steps(Index count, Index size) { return std::min(size, 2 * count + 20); }

}  // namespace

SymmetricEigen<Eigen::Dynamic> least_eigenpairs(const Eigen::SparseMatrix<double>& semidefinite,
                                                const Eigen::VectorXd& masses, Index count,
                                                double shift, const Context& context) {
  const Index size = semidefinite.rows();
  if (size <= gained_from * count) {
    SymmetricEigen<Eigen::Dynamic> all =
        eigen_of(Eigen::MatrixXd(semidefinite), Eigen::MatrixXd(masses.asDiagonal()));
    const Index kept = std::min(count, size);
    return {all.values.head(kept), all.vectors.leftCols(kept)};
  }
  const Eigen::VectorXd scale = masses.cwiseSqrt().cwiseInverse();
  const Eigen::SparseMatrix<double> scaled = scale.asDiagonal() * semidefinite * scale.asDiagonal();
  ShiftedInverse inverse(scaled, context);
  Spectra::SymEigsShiftSolver<ShiftedInverse> solver(inverse, count, lanczos_steps(count, size),
                                                     shift);
  solver.init();
  solver.compute(Spectra::SortRule::LargestMagn, restarts, tolerance,
                 Spectra::SortRule::SmallestAlge);
  return {solver.eigenvalues(), scale.asDiagonal() * solver.eigenvectors()};
}

SymmetricEigen<Eigen::Dynamic> greatest_eigenpairs(const Rows& symmetric, Index count,
                                                   const Context& context) {
  const Index size = symmetric.rows();
  if (size <= gained_from * count) {
    const auto [values, vectors] =
        eigen_of(Eigen::MatrixXd(symmetric), Eigen::MatrixXd::Identity(size, size));
    return {values.tail(count).reverse(), vectors.rightCols(count).rowwise().reverse()};
  }
  Product product{symmetric, context};
  Spectra::SymEigsSolver<Product> solver(product, count, lanczos_steps(count, size));
  solver.init();
  solver.compute(Spectra::SortRule::LargestAlge, restarts, tolerance,
                 Spectra::SortRule::LargestAlge);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

}  // namespace symsurf
