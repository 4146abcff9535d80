#include "base/linear_algebra.h"

#include <Spectra/SymEigsShiftSolver.h>
#include <Spectra/SymEigsSolver.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <Eigen/SVD>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>

namespace symsurf {

// Through any size, which the pencils below need as well.
SymmetricEigen<2> eigen_of(const Eigen::Matrix2d& symmetric) {
  const SymmetricEigen<Eigen::Dynamic> eigen = eigen_of(Eigen::MatrixXd(symmetric));
  return {eigen.values, eigen.vectors};
}

SymmetricEigen<3> eigen_of(const Eigen::Matrix3d& symmetric) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(symmetric);
  return {eigen.eigenvalues(), eigen.eigenvectors()};
}

SymmetricEigen<Eigen::Dynamic> eigen_of(const Eigen::MatrixXd& symmetric) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(symmetric);
  return {eigen.eigenvalues(), eigen.eigenvectors()};
}

// Lazily: Eigen's product of matrices of any size is blocked, and takes longer to compile.
SymmetricEigen<3> eigen_of_scatter(const Points& rows) {
  return eigen_of(Matrix3(rows.transpose().lazyProduct(rows)));
}

SymmetricEigen<Eigen::Dynamic> eigen_of(const Eigen::MatrixXd& symmetric,
                                        const Eigen::MatrixXd& definite) {
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> eigen(symmetric, definite);
  return {eigen.eigenvalues(), eigen.eigenvectors()};
}

namespace {

struct Symmetric {
  double xx, yy, zz, yz, xz, xy;

  double trace() const { return xx + yy + zz; }
  Symmetric shifted(double by) const { return {xx - by, yy - by, zz - by, yz, xz, xy}; }
  Symmetric adjugate() const {
    return {yy * zz - yz * yz, zz * xx - xz * xz, xx * yy - xy * xy,
            xy * xz - xx * yz, xy * yz - yy * xz, xz * yz - zz * xy};
  }
  Vector3 operator*(const Vector3& v) const {
    return {xx * v.x() + xy * v.y() + xz * v.z(), xy * v.x() + yy * v.y() + yz * v.z(),
            xz * v.x() + yz * v.y() + zz * v.z()};
  }
  Vector3 column_of_largest() const {
    if (xx >= yy && xx >= zz) return {xx, xy, xz};
    return yy >= zz ? Vector3(xy, yy, yz) : Vector3(xz, yz, zz);
  }
};

Vector3 least_eigenvector_of(const Symmetric& m, const Symmetric& adjugate) {
  constexpr double rounding = 1e-12;
  constexpr int most = 32;
  constexpr double near_by = 1e-4;  // of the root: the next step would leave its square
  const double trace = m.trace(), minors = adjugate.trace();
  if (!(trace > 0)) return Vector3::UnitX();
  if (!(minors > rounding * trace * trace)) return m.column_of_largest().unitOrthogonal();
  const double determinant = m.xx * adjugate.xx + m.xy * adjugate.xy + m.xz * adjugate.xz;
  double root = 0;
  for (int step = 0; step < most; ++step) {
    const double slope = (3 * root - 2 * trace) * root + minors;
    if (!(slope > 0)) break;
    const double ahead = (determinant - ((root - trace) * root + minors) * root) / slope;
    root += ahead;
    if (ahead <= near_by * root) break;
  }
  const Symmetric inverse = m.shifted(root).adjugate();
  const Vector3 vector = inverse * (inverse * inverse.column_of_largest());
  const double length = vector.norm();
  return length > 0 ? Vector3(vector / length) : Vector3::UnitX();
}

}  // namespace

LeastEigen least_eigen_of(const Matrix3& matrix) {
  const Symmetric m{matrix(0, 0), matrix(1, 1), matrix(2, 2),
                    matrix(2, 1), matrix(2, 0), matrix(1, 0)};
  const Symmetric adjugate = m.adjugate();
  LeastEigen least;
  least.vector = least_eigenvector_of(m, adjugate);
  least.value = std::max(0.0, least.vector.dot(m * least.vector));
  const double sum = m.trace() - least.value, product = adjugate.trace() - least.value * sum;
  least.greatest = (sum + std::sqrt(std::max(0.0, sum * sum - 4 * product))) / 2;
  least.next = least.greatest > 0 ? std::max(0.0, product / least.greatest) : 0;
  return least;
}

Matrix3 nearest_orthogonal(const Matrix3& products, double parity) {
  const Eigen::JacobiSVD<Matrix3> svd(products, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const double turned = svd.matrixU().determinant() * svd.matrixV().determinant() * parity;
  return svd.matrixU() * Vector3(1, 1, turned > 0 ? 1 : -1).asDiagonal() *
         svd.matrixV().transpose();
}

Eigen::Isometry3d nearest_isometry(const std::vector<std::pair<Vector3, Vector3>>& pairs,
                                   double parity) {
  const auto count = static_cast<double>(pairs.size());
  Vector3 from = Vector3::Zero(), onto = Vector3::Zero();
  for (const auto& [x, y] : pairs) {
    from += x / count;
    onto += y / count;
  }
  Matrix3 products = Matrix3::Zero();
  for (const auto& [x, y] : pairs) products += (y - onto) * (x - from).transpose();
  return map_taking(nearest_orthogonal(products, parity), from, onto);
}

Matrix3 least_rotation(const Vector3& from, const Vector3& onto) {
  const Vector3 a = from.normalized(), b = onto.normalized();
  Vector3 middle = a + b;
  if (a.dot(b) < 0) {
    const Vector3 between = (b - a).normalized();
    middle -= middle.dot(between) * between;  // what rounding left of nearly opposite ones
    if (middle.isZero(0)) middle = a.unitOrthogonal();
  }
  const auto reflection = [](const Vector3& normal) -> Matrix3 {
    return Matrix3::Identity() - 2 * normal * normal.transpose();
  };
  return reflection(middle.normalized()) * reflection(a);
}

Eigen::Isometry3d map_taking(const Matrix3& linear, const Vector3& from, const Vector3& onto) {
  Eigen::Isometry3d map = Eigen::Isometry3d::Identity();
  map.linear() = linear;
  map.translation() = onto - linear * from;
  return map;
}

Eigen::VectorXd solved(const Eigen::MatrixXd& semidefinite, const Eigen::VectorXd& right) {
  return semidefinite.ldlt().solve(right);
}

template <int n>
requires(n >= 3 &&
         n <= 7) Eigen::Vector<double, n> solved(const Eigen::Matrix<double, n, n>& semidefinite,
                                                 const Eigen::Vector<double, n>& right) {
  // One decomposition for all sizes: one for each takes five times as long to compile.
  using Small = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, 7, 7>;
  using Column = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, 7, 1>;
  const Column solution = Eigen::LDLT<Small>(semidefinite).solve(Column(right));
  return solution;
}

#define SYMSURF_SOLVED(n)                                                      \
  template Eigen::Vector<double, n> solved(const Eigen::Matrix<double, n, n>&, \
                                           const Eigen::Vector<double, n>&)
SYMSURF_SOLVED(3);
SYMSURF_SOLVED(4);
SYMSURF_SOLVED(5);
SYMSURF_SOLVED(6);
SYMSURF_SOLVED(7);
#undef SYMSURF_SOLVED

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

// |x|^2 = 2 c . x + r^2 - |c|^2 is linear in what is sought.
Eigen::VectorXd sphere_through(const Eigen::MatrixXd& rows) {
  Eigen::MatrixXd design(rows.rows(), rows.cols() + 1);
  design << 2 * rows, Eigen::VectorXd::Ones(rows.rows());
  Eigen::VectorXd fit =
      solved(design.transpose() * design, design.transpose() * rows.rowwise().squaredNorm());
  double& last = fit[rows.cols()];
  last = std::sqrt(std::max(0.0, last + fit.head(rows.cols()).squaredNorm()));
  return fit;
}

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
