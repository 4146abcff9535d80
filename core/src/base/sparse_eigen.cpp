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

// y = A x, for Spectra.
struct Product {
  using Scalar = double;
  const std::function<Eigen::VectorXd(const Eigen::VectorXd&)>& multiply;
  Index size;
  const Context& context;

  Eigen::Index rows() const { return size; }
  Eigen::Index cols() const { return size; }

  void perform_op(const double* x, double* y) const {
    context.check();
    Eigen::Map<Eigen::VectorXd>(y, size) = multiply(Eigen::Map<const Eigen::VectorXd>(x, size));
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

SymmetricEigen<Eigen::Dynamic> greatest_eigenpairs(
    const std::function<Eigen::VectorXd(const Eigen::VectorXd&)>& multiply, Index size, Index count,
    const Context& context) {
  Product product{multiply, size, context};
  if (size <= gained_from * count) {
    const Eigen::MatrixXd identity = Eigen::MatrixXd::Identity(size, size);
    Eigen::MatrixXd matrix(size, size);
    for (Index k = 0; k < size; ++k)
      product.perform_op(identity.col(k).data(), matrix.col(k).data());
    const auto [values, vectors] = eigen_of(matrix, identity);
    return {values.tail(count).reverse(), vectors.rightCols(count).rowwise().reverse()};
  }
  Spectra::SymEigsSolver<Product> solver(product, count, lanczos_steps(count, size));
  solver.init();
  solver.compute(Spectra::SortRule::LargestAlge, restarts, tolerance,
                 Spectra::SortRule::LargestAlge);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

}  // namespace symsurf
