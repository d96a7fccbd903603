#include "mission/sampling/joint_spread.h"

#include "base/number.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>
#include <utility>

#include <Eigen/Eigenvalues>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <boost/math/interpolators/cubic_hermite.hpp>

namespace flightwatt::mission {
namespace {

constexpr double min_chance = 1e-300;

// In long doubles they would take three times as long.
using Policy = boost::math::policies::policy<boost::math::policies::promote_double<false>>;
using Student = boost::math::students_t_distribution<double, Policy>;
using Normal = boost::math::normal_distribution<double, Policy>;

/// Student's t with the same tail probability as a positive standard normal number.
double exact_student(double normal, double degrees_of_freedom) {
    const double beyond = std::max(min_chance, cdf(complement(Normal(), normal)));
    return quantile(complement(Student(degrees_of_freedom), beyond));
}

/// The same of numbers up to `end`, a hundred times faster, by its area hyperbolic sine, which rises slowly.
class StudentTable {
  public:
    static constexpr double end = 8.0;

    explicit StudentTable(double degrees_of_freedom) {
        std::vector<double> values;
        std::vector<double> slopes;
        for (int i = 0; i <= per_unit * static_cast<int>(end); ++i) {
            const double normal = static_cast<double>(i) / per_unit;
            const double t = exact_student(normal, degrees_of_freedom);
            values.push_back(std::asinh(t));
            slopes.push_back(pdf(Normal(), normal) / pdf(Student(degrees_of_freedom), t) / std::hypot(1.0, t));
        }
        area_sinh_.emplace(std::move(values), std::move(slopes), 0.0, 1.0 / per_unit);
    }

    double operator()(double normal) const { return std::sinh((*area_sinh_)(normal)); }

  private:
    static constexpr int per_unit = 128;
    std::optional<boost::math::interpolators::cardinal_cubic_hermite<std::vector<double>>> area_sinh_;
};

/// The table of some degrees of freedom, made once. Each thread knows where it is: drawn flights need it often.
const StudentTable& student_table(double degrees_of_freedom) {
    thread_local std::map<double, const StudentTable*> known;
    auto& table = known[degrees_of_freedom];
    if (table == nullptr) {
        static std::mutex mutex;
        static std::map<double, StudentTable> tables;
        const std::lock_guard lock(mutex);
        table = &tables.try_emplace(degrees_of_freedom, degrees_of_freedom).first->second;
    }
    return *table;
}

/// The flights that have the quantity of each of `spreads`, a row a flight, less their means.
Eigen::MatrixXd centred_flights(const std::vector<EstimatedSpread>& spreads) {
    std::size_t flights = 0;
    for (const auto& spread : spreads) flights = std::max(flights, spread.flight_values.size());
    std::vector<Eigen::RowVectorXd> rows;
    for (std::size_t i = 0; i < flights; ++i) {
        Eigen::RowVectorXd row(static_cast<Eigen::Index>(spreads.size()));
        bool is_complete = true;
        for (std::size_t k = 0; k < spreads.size(); ++k) {
            if (!is_known_of_flights(spreads[k])) {
                row(static_cast<Eigen::Index>(k)) = 0.0;
                continue;
            }
            const auto& value = spreads[k].flight_values[i];
            is_complete = is_complete && value.has_value();
            row(static_cast<Eigen::Index>(k)) = value.value_or(0.0);
        }
        if (is_complete) rows.push_back(row);
    }
    Eigen::MatrixXd table(static_cast<Eigen::Index>(rows.size()), static_cast<Eigen::Index>(spreads.size()));
    for (std::size_t i = 0; i < rows.size(); ++i) table.row(static_cast<Eigen::Index>(i)) = rows[i];
    if (!rows.empty()) table.rowwise() -= table.colwise().mean().eval();
    return table;
}

/// Correlations of the columns; none of a column that does not change.
Eigen::MatrixXd correlations_of(const Eigen::MatrixXd& centred) {
    Eigen::MatrixXd standard = centred;
    for (Eigen::Index k = 0; k < standard.cols(); ++k) {
        const double length = standard.col(k).norm();
        if (length > 0.0) standard.col(k) /= length;
    }
    Eigen::MatrixXd correlations = standard.transpose() * standard;
    correlations.diagonal().setOnes();
    return correlations;
}

/// The symmetric root of a matrix that has no negative eigenvalues but for rounding.
Eigen::MatrixXd root_of(const Eigen::MatrixXd& matrix) {
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> parts(matrix);
    const Eigen::VectorXd roots = parts.eigenvalues().cwiseMax(0.0).cwiseSqrt();
    return parts.eigenvectors() * roots.asDiagonal() * parts.eigenvectors().transpose();
}

/// Returns the part of new flights beyond a threshold that flights drawn by Student's t exceed with probability `drawn`:
/// the true part is greater with `confidence`. The threshold is `t` deviations of the flights' mean away: a noncentral t, whose
/// parameter is found by the distribution of the deviation.
double share_at(double drawn, double degrees_of_freedom, double confidence) {
    if (!(drawn > 0.0 && drawn < 1.0)) return drawn;
    constexpr int nodes = 200;
    const double flights = degrees_of_freedom + 1.0;
    const double t = quantile(complement(Student(degrees_of_freedom), drawn)) * std::sqrt(flights + 1.0);
    std::vector<double> shifted;
    shifted.reserve(nodes);
    const boost::math::chi_squared_distribution<double, Policy> squares(degrees_of_freedom);
    for (int i = 0; i < nodes; ++i)
        shifted.push_back(t * std::sqrt(quantile(squares, (i + 0.5) / nodes) / degrees_of_freedom));
    const auto [least, most] = std::ranges::minmax(shifted);
    constexpr double far = 10.0;  // standard normal deviations
    constexpr int halvings = 60;
    const double parameter = last_true(least - far, most + far, halvings, [&](double tried) {
        double above = 0.0;
        for (const double at : shifted) above += cdf(Normal(), at - tried) / nodes;
        return above > 1.0 - confidence;
    });
    return cdf(complement(Normal(), parameter / std::sqrt(flights)));
}

}  // namespace

Interval interval_of_share(const Interval& drawn, double degrees_of_freedom) {
    if (std::isinf(degrees_of_freedom)) return drawn;
    constexpr double tail = 0.025;
    return {share_at(drawn.low, degrees_of_freedom, 1.0 - tail), share_at(drawn.high, degrees_of_freedom, tail)};
}

double student_from_normal(double normal, double degrees_of_freedom) {
    if (normal == 0.0 || std::isinf(degrees_of_freedom)) return normal;
    const double size = std::abs(normal);
    const double student =
        size < StudentTable::end ? student_table(degrees_of_freedom)(size) : exact_student(size, degrees_of_freedom);
    return std::copysign(std::min(student, max_student), normal);
}

std::vector<double> student_vector(std::span<const double> normals, double degrees_of_freedom) {
    std::vector<double> numbers;
    double square_sum = 0.0;
    double freedom = degrees_of_freedom;
    for (const double normal : normals) {
        const double scale = std::isinf(freedom) ? 1.0 : std::sqrt((degrees_of_freedom + square_sum) / freedom);
        numbers.push_back(scale * student_from_normal(normal, freedom));
        square_sum += numbers.back() * numbers.back();
        freedom += 1.0;
    }
    return numbers;
}

bool is_known_of_flights(const EstimatedSpread& spread) {
    return std::ranges::count_if(spread.flight_values, [](const auto& value) { return value.has_value(); }) >= 2;
}

std::vector<JointDistribution> estimate_joint_distributions(const std::vector<EstimatedSpread>& spreads) {
    std::map<double, std::vector<EstimatedSpread>> of_freedom;
    for (const auto& spread : spreads)
        if (spread.sd > 0.0) of_freedom[spread.degrees_of_freedom].push_back(spread);
    std::vector<JointDistribution> joints;
    for (const auto& [degrees_of_freedom, together] : of_freedom) {
        JointDistribution joint{degrees_of_freedom, {}, root_of(correlations_of(centred_flights(together)))};
        for (std::size_t k = 0; k < together.size(); ++k) {
            joint.quantities.push_back(together[k].quantity);
            joint.factor.row(static_cast<Eigen::Index>(k)) *= together[k].sd;
        }
        joints.push_back(std::move(joint));
    }
    return joints;
}

}  // namespace flightwatt::mission
