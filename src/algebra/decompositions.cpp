#include "algebra/decompositions.hpp"

#include <Eigen/Dense>
#include <Eigen/Sparse>
#include <limits>
#include <new>
#include <string>

namespace dinal::algebra {
namespace {

class FactoredSparse final : public Factored {
public:
    explicit FactoredSparse(const Eigen::SparseMatrix<double>& A) {
        decomposition_.compute(A);
        // Eigen catches a failed allocation and reports it with "MEMORY" in the message; a singular matrix fails
        // likewise.
        const bool lacks_memory = decomposition_.lastErrorMessage().find("MEMORY") != std::string::npos;
        if (decomposition_.info() != Eigen::Success && lacks_memory) throw std::bad_alloc();
    }
    void solve(const Eigen::VectorXd& b, Eigen::VectorXd& x) const override {
        if (decomposition_.info() == Eigen::Success) {
            x = decomposition_.solve(b);
        } else {
            x = Eigen::VectorXd::Constant(b.size(), std::numeric_limits<double>::quiet_NaN());
        }
    }

private:
    Eigen::SparseLU<Eigen::SparseMatrix<double>> decomposition_;
};

/// A square matrix needs no QR step before its singular value decomposition.
using SingularValues = Eigen::JacobiSVD<Eigen::MatrixXd, Eigen::NoQRPreconditioner>;

}  // namespace

std::unique_ptr<const Factored> factored_sparse(Eigen::Index size, const std::vector<Entry>& entries) {
    std::vector<Eigen::Triplet<double>> triplets;
    triplets.reserve(entries.size());
    for (const Entry& entry : entries) triplets.emplace_back(entry.row, entry.column, entry.value);
    Eigen::SparseMatrix<double> A(size, size);
    A.setFromTriplets(triplets.begin(), triplets.end());
    return std::make_unique<FactoredSparse>(A);
}

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
