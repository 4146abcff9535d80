#pragma once

#include <symsurf/context.h>
#include <symsurf/points.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <Eigen/SparseCore>
#include <cstdint>
#include <utility>
#include <vector>

namespace symsurf {

// Eigen's decompositions are slow to compile: those that many searches need are compiled once,
// these and that of least_squares.h. They look at the lower triangle.

/// Eigenvalues, ascending, and unit eigenvectors, one a column.
template <int n>
struct SymmetricEigen {
  Eigen::Vector<double, n> values;
  Eigen::Matrix<double, n, n> vectors;
};

/// By tridiagonalisation and implicit QR steps (Golub and Van Loan, "Matrix Computations", 8.3).
SymmetricEigen<2> eigen_of(const Eigen::Matrix2d& symmetric);
SymmetricEigen<3> eigen_of(const Eigen::Matrix3d& symmetric);
SymmetricEigen<Eigen::Dynamic> eigen_of(const Eigen::MatrixXd& symmetric);

/// Of the sum of the products of each row with itself.
SymmetricEigen<3> eigen_of_scatter(const Points& rows);

/// The same of A v = lambda B v, v' B v = 1, for a positive definite B (Golub and Van Loan, 8.7).
SymmetricEigen<Eigen::Dynamic> eigen_of(const Eigen::MatrixXd& symmetric,
                                        const Eigen::MatrixXd& definite);

/// The least eigenvalue of a semidefinite matrix with its unit eigenvector, and the others.
struct LeastEigen {
  double value, next, greatest;
  Vector3 vector;
};

/// In a quarter of the time of eigen_of: Newton's steps on the characteristic polynomial, from
/// below, then inverse iterations with the adjugate in the inverse's place (Golub and Van Loan,
/// 7.6.1). For entries that have a fourth power.
LeastEigen least_eigen_of(const Matrix3& semidefinite);

/// The orthogonal map Q with the greatest trace(Q' products), a rotation for a parity of 1, with a
/// reflection for -1. Of products sum y x' it takes points x nearest to points y (Umeyama 1991).
Matrix3 nearest_orthogonal(const Matrix3& products, double parity);

/// The motion, or reflection, that takes the first points of pairs nearest to the second ones.
Eigen::Isometry3d nearest_isometry(const std::vector<std::pair<Vector3, Vector3>>& pairs,
                                   double parity);

/// The rotation by the least angle that takes a direction to another, as two reflections: by pi
/// about any axis across it to the opposite one.
Matrix3 least_rotation(const Vector3& from, const Vector3& onto);

/// x -> linear (x - from) + onto.
Eigen::Isometry3d map_taking(const Matrix3& linear, const Vector3& from, const Vector3& onto);

/// x of A x = b for a semidefinite A by L D L' with pivots (Golub and Van Loan, 4.2); 0 along what
/// A leaves open. Looks at the lower triangle.
Eigen::VectorXd solved(const Eigen::MatrixXd& semidefinite, const Eigen::VectorXd& right);

/// The same in less time, where many are solved.
template <int n>
requires(n >= 3 &&
         n <= 7) Eigen::Vector<double, n> solved(const Eigen::Matrix<double, n, n>& semidefinite,
                                                 const Eigen::Vector<double, n>& right);

/// Centre and, last, radius of the sphere, or of the circle, about which |x - c|^2 - r^2 of the
/// rows has the least squares; 0 where r^2 is not above 0. For rows that are about 1 in size.
Eigen::VectorXd sphere_through(const Eigen::MatrixXd& rows);

/// Weighted least squares fit of z = h . (1, u, v, u^2, u v, v^2).
class QuadraticFit {
 public:
  using Coefficients = Eigen::Vector<double, 6>;

  void add(double u, double v, double z, double weight = 1) {
    const Coefficients row{{1, u, v, u * u, u * v, v * v}};
    normal_.selfadjointView<Eigen::Lower>().rankUpdate(row, weight);
    right_ += weight * z * row;
  }

  /// The sum of all.
  double weight() const { return normal_(0, 0); }

  /// h, its second derivatives, slopes and height drawn to 0 by ridges on the diagonal of the
  /// normal equations.
  Coefficients coefficients(double bends = 0, double slopes = 0, double height = 0) const {
    Eigen::Matrix<double, 6, 6> ridged = normal_;
    ridged.diagonal() += Coefficients{{height, slopes, slopes, bends, bends, bends}};
    return solved(ridged, right_);
  }

 private:
  Eigen::Matrix<double, 6, 6> normal_ = Eigen::Matrix<double, 6, 6>::Zero();  // lower triangle
  Coefficients right_ = Coefficients::Zero();
};

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
