#include "algebra/decompositions.hpp"

#include <Eigen/Dense>
#include <limits>

namespace dinal::algebra {
namespace {

/// A square matrix needs no QR step before its singular value decomposition.
using SingularValues = Eigen::JacobiSVD<Eigen::MatrixXd, Eigen::NoQRPreconditioner>;

}  // namespace

Eigen::MatrixXd inverse(const Eigen::MatrixXd& A) {
    return A.inverse();
}
Eigen::MatrixXcd inverse(const Eigen::MatrixXcd& A) {
    return A.inverse();
}

double determinant(const Eigen::MatrixXd& A) {
    return A.determinant();
}

Eigen::VectorXd solve_symmetric(const Eigen::MatrixXd& A, const Eigen::VectorXd& b) {
    return A.ldlt().solve(b);
}

Eigen::VectorXd solve_least_squares(const Eigen::MatrixXd& A, const Eigen::VectorXd& b) {
    return A.colPivHouseholderQr().solve(b);
}

Eigen::VectorXd solve_by_singular_values(const Eigen::MatrixXd& A, const Eigen::VectorXd& b, double threshold) {
    SingularValues parts(A, Eigen::ComputeFullU | Eigen::ComputeFullV);
    parts.setThreshold(threshold);
    return parts.solve(b);
}

Eigen::MatrixXd pseudo_inverse(const Eigen::MatrixXd& A) {
    return A.completeOrthogonalDecomposition().pseudoInverse();
}

Eigen::MatrixXd triangular_factor(const Eigen::MatrixXd& A) {
    return Eigen::HouseholderQR<Eigen::MatrixXd>(A).matrixQR().topRows(A.cols());
}

Eigen::MatrixXd inverse_of_triangular(const Eigen::MatrixXd& R) {
    return R.triangularView<Eigen::Upper>().solve(Eigen::MatrixXd::Identity(R.rows(), R.cols()));
}

Basis orthonormal_basis(const Eigen::MatrixXd& A) {
    const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> parts(A);
    return {parts.householderQ() * Eigen::MatrixXd::Identity(A.rows(), A.rows()), parts.rank()};
}

FreeDirection free_direction(const Eigen::MatrixXd& rows) {
    const Eigen::Index n = rows.rows();
    const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> parts(rows.transpose());
    return {parts.householderQ() * Eigen::VectorXd::Unit(n + 1, n), parts.matrixR()(n - 1, n - 1)};
}

Eigen::VectorXd most_shortened(const Eigen::MatrixXd& A) {
    return SingularValues(A, Eigen::ComputeFullV).matrixV().col(A.cols() - 1);
}

Eigen::VectorXcd eigenvalues(const Eigen::MatrixXd& A) {
    return A.eigenvalues();
}

Eigenpairs eigenpairs(const Eigen::MatrixXd& A) {
    const Eigen::EigenSolver<Eigen::MatrixXd> parts(A);
    return {parts.eigenvalues(), parts.eigenvectors()};
}

double largest_eigenvalue_of_symmetric(const Eigen::MatrixXd& A) {
    return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(A, Eigen::EigenvaluesOnly).eigenvalues()(A.rows() - 1);
}

}  // namespace dinal::algebra
