#pragma once

#include "mission/sampling/flight_draws.h"
#include "mission/sampling/flight_lanes.h"
#include "mission/sampling/student.h"

#include <atomic>
#include <map>
#include <span>
#include <vector>

namespace flightwatt::mission {

/// Beyond, nothing is as probable as 1e-18 [deviations].
inline constexpr double max_deviation = 9.0;

/// Between which of its flights a line keeps some state of charge, and what those that were flown were left with.
struct LineSearch {
    double threshold = 0.0;                    ///< [deviations]: beyond, flights fall below it
    double better_threshold = -max_deviation;  ///< and before: where better in one is far out in others
    std::vector<double> offset{};              ///< where the line lies beside others; empty before its first flight
    std::map<double, double> evaluations{};    ///< by where its flights are
};

/// The chance of the flights of a line that fall below.
double line_failure_probability(const LineSearch& line);

/// Lines of flights, each from the best to the worst: parallel to where flights lose most, and so far beside each other
/// as normal numbers are. The flights are distributed as those that flight_of makes of `mission`, which has to outlive
/// the lines; but what is drawn together is turned so that its first number alone makes flights worse, to first order.
class LineSampler {
  public:
    LineSampler(const Mission& mission, const FlightUncertainty& spreads);

    double nominal_percent() const { return stated_percent_; }  ///< what the flight as stated lands with
    /// What the flights are left with goes as the stated less this times a Student t with those degrees of freedom, to
    /// first order (Welch and Satterthwaite's where several sources add; infinite: normal).
    double sd_percent() const { return sd_percent_; }
    double degrees_of_freedom() const { return degrees_of_freedom_; }
    bool some_fail() const { return some_fail_; }  ///< of those that were flown
    std::size_t flown() const { return flown_; }   ///< flights

    /// Where a line falls below `evaluations`, from the threshold that the search says: on both of its sides, since
    /// what is drawn together is far out together. Between them all flights keep more.
    void find_thresholds(std::size_t line, double left_percent, LineSearch& search) const;

    /// What flights number `from` and on are left with, drawn without regard to lines.
    void simulate_random(std::size_t from, std::span<double> left_percent) const;

    /// From now on along where the flights beyond the thresholds of lines are, by their chance.
    void redirect_to_failures(const std::vector<LineSearch>& searches);

  private:
    double left_percent_of(std::span<const double> normals) const;
    std::vector<double> left_percent_of_all(std::span<const std::vector<double>> normals) const;
    void count(std::span<const double> left_percent) const;
    std::vector<double> across_of(std::size_t line) const;
    double fly(double at, LineSearch& search) const;
    /// Where nothing is spare if so much is at `at`, as what is left falls evenly with a Student t.
    double linear_threshold(double at, double spare_percent) const;
    bool find_kept(double left_percent, LineSearch& search) const;
    void find_worse_threshold(double left_percent, LineSearch& search) const;
    void find_better_threshold(double left_percent, LineSearch& search) const;
    void set_direction(std::vector<double> direction);
    std::vector<double> lost_percent_along(const std::vector<std::size_t>& numbers) const;
    void find_scale();

    FlightUncertainty spreads_;
    MissionSetup setup_;
    const Schedule& schedule_;
    SimdFlightSimulator lanes_;
    mutable std::atomic<std::size_t> flown_ = 0;
    mutable std::atomic<bool> some_fail_ = false;
    std::vector<double> important_direction_;  ///< the direction, of length 1
    double stated_percent_ = 0.0;
    double sd_percent_ = 0.0;
    double degrees_of_freedom_ = infinite_dof;
};

/// The chance to be left with less than some state of charge, over the lines so far: docs/methods.md, Eq. 34.
class LineSamplingEstimate {
  public:
    LineSamplingEstimate(const LineSampler& lines, double left_percent);

    std::size_t lines() const { return searches_.size(); }
    double left_percent() const { return left_percent_; }
    double chance() const;
    double standard_error() const;
    const std::vector<LineSearch>& searches() const { return searches_; }

    /// As many again.
    void double_lines();
    void move_to(double left_percent);

  private:
    void solve(std::size_t from);
    std::vector<double> of_pairs() const;

    const LineSampler* lines_;
    double left_percent_;
    std::vector<LineSearch> searches_;
};

}  // namespace flightwatt::mission
