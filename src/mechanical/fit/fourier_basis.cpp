#include "mechanical/fit/fourier_basis.h"

#include <cmath>
#include <vector>

#include <Eigen/SVD>

namespace flightwatt::mechanical {

void fourier_row(double angle, int order, std::span<double> row) {
    const double c = std::cos(angle);
    const double s = std::sin(angle);
    row[0] = 1.0;
    double cos_n = 1.0;
    double sin_n = 0.0;
    for (std::size_t n = 1; n <= static_cast<std::size_t>(order); ++n) {
        const double next = cos_n * c - sin_n * s;
        sin_n = sin_n * c + cos_n * s;
        cos_n = next;
        row[2 * n - 1] = cos_n;
        row[2 * n] = sin_n;
    }
}

Eigen::MatrixXd fourier_basis(std::span<const double> tau, int order, double theta_rad) {
    Eigen::MatrixXd basis(static_cast<Eigen::Index>(tau.size()), coefficient_count(order));
    std::vector<double> row(static_cast<std::size_t>(coefficient_count(order)));
    for (std::size_t i = 0; i < tau.size(); ++i) {
        fourier_row(theta_rad * tau[i], order, row);
        basis.row(static_cast<Eigen::Index>(i)) =
            Eigen::Map<const Eigen::RowVectorXd>(row.data(), coefficient_count(order));
    }
    return basis;
}

double basis_condition(int order, double theta_rad, std::size_t samples) {
    std::vector<double> tau(samples);
    for (std::size_t i = 0; i < samples; ++i) {
        tau[i] = (static_cast<double>(i) + 0.5) / static_cast<double>(samples);
    }
    Eigen::MatrixXd basis = fourier_basis(tau, order, theta_rad);
    basis.colwise().normalize();
    const Eigen::VectorXd singular = Eigen::JacobiSVD<Eigen::MatrixXd>(basis).singularValues();
    return singular(0) / singular(singular.size() - 1);
}

}  // namespace flightwatt::mechanical
