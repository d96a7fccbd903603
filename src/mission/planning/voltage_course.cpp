#include "mission/planning/voltage_course.h"

#include "base/piecewise_linear.h"
#include "mission/simulation.h"

#include <algorithm>
#include <cmath>

namespace flightwatt::mission {
namespace {

constexpr double point_every_s = 0.1;
constexpr double repeated_time_s = 1e-9;

/// How much the lines bend, in voltage over the longer of two neighbours: an interpolated smooth curve is off
/// by an eighth of that, one with a corner by less than all of it.
double greatest_bend_v(const VoltageCourse& course) {
    double bend_v = 0.0;
    for (std::size_t i = 2; i < course.time_s.size(); ++i) {
        const double before_s = course.time_s[i - 1] - course.time_s[i - 2];
        const double after_s = course.time_s[i] - course.time_s[i - 1];
        const double before_v_per_s = (course.voltage_v[i - 1] - course.voltage_v[i - 2]) / before_s;
        const double after_v_per_s = (course.voltage_v[i] - course.voltage_v[i - 1]) / after_s;
        bend_v = std::max(bend_v, std::abs(after_v_per_s - before_v_per_s) * std::max(before_s, after_s));
    }
    return bend_v;
}

}  // namespace

double voltage_v(const VoltageCourse& course, double time_s) {
    return interpolate_clamped(course.time_s, course.voltage_v, time_s);
}

std::optional<VoltageCourse> voltage_course_of(const MissionSetup& mission,
                                               const std::vector<ScheduleSegment>& schedule) {
    const auto simulation = simulate(mission, schedule, {point_every_s, point_every_s, false});
    if (!simulation.summary.feasible) return std::nullopt;
    VoltageCourse course;
    for (const auto& row : simulation.curve.rows) {
        // At a jump the current changes, the source does not.
        if (!course.time_s.empty() && row.time_s - course.time_s.back() < repeated_time_s) continue;
        course.time_s.push_back(row.time_s);
        course.voltage_v.push_back(row.terminal_voltage_v + mission.battery.resistance_ohm * row.current_a);
    }
    course.error_v = greatest_bend_v(course);
    return course;
}

}  // namespace flightwatt::mission
