// Linear systems, least squares and eigenvalues of dense matrices. Eigen's decompositions take seconds to compile: each
// is compiled once, in decompositions.cpp, and other rooms include no more of Eigen than Core.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace dinal::algebra {

Eigen::MatrixXd inverse(const Eigen::MatrixXd& A);
Eigen::MatrixXcd inverse(const Eigen::MatrixXcd& A);
double determinant(const Eigen::MatrixXd& A);

/// Solves A x = b for a symmetric A (Cholesky's LDL^T).
Eigen::VectorXd solve_symmetric(const Eigen::MatrixXd& A, const Eigen::VectorXd& b);

/// Least squares by QR with column pivoting: components that A does not determine are 0.
Eigen::VectorXd solve_least_squares(const Eigen::MatrixXd& A, const Eigen::VectorXd& b);
/// The shortest x with the least |A x - b| for a square A, by its singular values; those below `threshold` times the
/// largest one count as 0.
Eigen::VectorXd solve_by_singular_values(const Eigen::MatrixXd& A, const Eigen::VectorXd& b, double threshold);
Eigen::MatrixXd pseudo_inverse(const Eigen::MatrixXd& A);

/// The upper triangular R of A = Q R, with as many rows as A has columns.
Eigen::MatrixXd triangular_factor(const Eigen::MatrixXd& A);
Eigen::MatrixXd inverse_of_triangular(const Eigen::MatrixXd& R);

/// An orthonormal basis of the whole space; its first `rank` columns span the columns of A.
struct Basis {
    Eigen::MatrixXd columns;
    Eigen::Index rank;
};
Basis orthonormal_basis(const Eigen::MatrixXd& A);

/// The direction that n independent rows of n + 1 elements leave free; `last_pivot` is 0 if they are dependent.
struct FreeDirection {
    Eigen::VectorXd direction;
    double last_pivot;
};
FreeDirection free_direction(const Eigen::MatrixXd& rows);
/// The direction that a square A shortens most: the last right singular vector.
Eigen::VectorXd most_shortened(const Eigen::MatrixXd& A);

Eigen::VectorXcd eigenvalues(const Eigen::MatrixXd& A);
struct Eigenpairs {
    Eigen::VectorXcd values;
    Eigen::MatrixXcd vectors;
};
Eigenpairs eigenpairs(const Eigen::MatrixXd& A);
double largest_eigenvalue_of_symmetric(const Eigen::MatrixXd& A);

}  // namespace dinal::algebra
