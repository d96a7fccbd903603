#include "answer/pack_temperature.h"

#include "base/units.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace flightwatt::answer {
namespace {

/// Flights with a temperature, by which they are sorted, and a resistance of their own, with that of the RC pair, which
/// they have in common: their own change by what it changes too.
struct ComparedFlights {
    std::vector<double> at_c;
    std::vector<double> log_ohm;
    double log_error = 0.0;  ///< standard error of one, root mean square
};

ComparedFlights compared_flights(std::vector<battery::IdentifiedFlight> flights,
                                 std::optional<double> battery::IdentifiedFlight::*temperature_c,
                                 double rc_resistance_ohm) {
    std::erase_if(flights, [&](const auto& flight) { return !(flight.*temperature_c) || !flight.resistance; });
    std::ranges::sort(flights, {}, temperature_c);
    ComparedFlights compared;
    double squares = 0.0;
    for (const auto& flight : flights) {
        compared.at_c.push_back(*(flight.*temperature_c));
        const double ohm = flight.resistance->value_ohm + rc_resistance_ohm;
        compared.log_ohm.push_back(std::log(ohm));
        squares += std::pow(flight.resistance->standard_error_ohm / ohm, 2);
    }
    if (!flights.empty()) compared.log_error = std::sqrt(squares / static_cast<double>(flights.size()));
    return compared;
}

/// Whether two flights are far enough in temperature from two others.
bool differ(const std::vector<double>& at_c) {
    return at_c.size() >= 4 && at_c[at_c.size() - 2] - at_c[1] >= like_temperature_k;
}

/// The resistance at a temperature, and what it rests on.
struct Resistance {
    double ohm = 0.0;
    Interval interval_ohm;  ///< 95 %
    std::string basis;
};

/// The straight line through ln R of the flights, of which `series_part` is the series resistance.
Resistance on_line(const ComparedFlights& flights, double at_c, double series_part) {
    const auto count = static_cast<double>(flights.at_c.size());
    const double mean_c = mean(flights.at_c);
    const double mean_log = mean(flights.log_ohm);
    double squares = 0.0;
    double products = 0.0;
    for (std::size_t i = 0; i < flights.at_c.size(); ++i) {
        squares += std::pow(flights.at_c[i] - mean_c, 2);
        products += (flights.at_c[i] - mean_c) * (flights.log_ohm[i] - mean_log);
    }
    const double slope = products / squares;
    double residuals = 0.0;
    for (std::size_t i = 0; i < flights.at_c.size(); ++i)
        residuals += std::pow(flights.log_ohm[i] - mean_log - slope * (flights.at_c[i] - mean_c), 2);
    const double sd = std::max(std::sqrt(residuals / (count - 2.0)), flights.log_error);
    const double half =
        student_t_half_width(count - 2.0) * sd * std::sqrt(1.0 / count + std::pow(at_c - mean_c, 2) / squares);
    const double ohm = series_part * std::exp(mean_log + slope * (at_c - mean_c));
    return {ohm, {ohm * std::exp(-half), ohm * std::exp(half)}, "measured"};
}

/// The resistance by the law of warming, from that at another temperature.
Resistance by_law(const Resistance& known, double known_c, double at_c) {
    const double change = battery::resistance_fall_per_k * (known_c - at_c);
    const double half = 0.5 * std::abs(change);
    return {known.ohm * std::exp(change),
            {known.interval_ohm.low * std::exp(change - half), known.interval_ohm.high * std::exp(change + half)},
            fmt::format("assumed: {:g} % (1.5 to 4.5) a kelvin colder, from {:.0f} degC on",
                        units::percentage(battery::resistance_fall_per_k, 1.0), known_c)};
}

void apply(const Resistance& found, battery::Battery& battery) {
    const double factor = found.ohm / battery.resistance_ohm;
    battery.resistance_ohm = found.ohm;
    battery.intervals.resistance_ohm = found.interval_ohm;
    if (auto& scatter = battery.intervals.resistance_scatter) scatter->sd_ohm *= factor;
    battery.thevenin.value().rc_resistance_ohm *= factor;
    if (auto& of_rc = battery.intervals.rc_resistance_ohm) of_rc = {of_rc->low * factor, of_rc->high * factor};
}

}  // namespace

void set_temperature(FoundPack& pack, double temperature_c, const std::vector<Pack>& packs) {
    auto& answer = pack.answer;
    answer.asked_temperature_c = temperature_c;
    const auto& range = answer.battery_start_c ? answer.battery_start_c : answer.air_temperature_c;
    if (!answer.resistance_ohm.value || !range) {
        answer.resistance_at_ohm =
            unknown(fmt::format("the effect of {:g} degC is unknown: {}", temperature_c,
                                answer.resistance_ohm.value
                                    ? "no log states a temperature; a flight at about that temperature shows it, on a "
                                      "battery monitor that measures the pack's"
                                    : "the flights determine no resistance"));
        return;
    }
    const auto of = answer.battery_start_c ? &battery::IdentifiedFlight::battery_start_c
                                           : &battery::IdentifiedFlight::air_temperature_c;
    const double series_ohm = pack.battery.resistance_ohm;
    const double rc_ohm = pack.battery.thevenin.value().rc_resistance_ohm;
    const auto flights = compared_flights(pack.identified->flights, of, rc_ohm);
    const bool is_measured = packs.size() < 2 && differ(flights.at_c);
    Resistance found{pack.battery.resistance_ohm, pack.identified->errors.resistance_ohm, "as measured"};
    const double flights_c = flights.at_c.empty() ? 0.5 * (range->low + range->high) : mean(flights.at_c);
    double found_c = is_measured ? std::clamp(temperature_c, range->low, range->high) : flights_c;
    const bool is_near = std::abs(temperature_c - found_c) <= like_temperature_k;
    if (is_measured) {
        found_c = is_near ? temperature_c : found_c;
        found = on_line(flights, found_c, series_ohm / (series_ohm + rc_ohm));
    }
    if (!is_near)
        found = by_law(found, found_c, temperature_c);
    else
        found.basis +=
            fmt::format(" at {:.0f} to {:.0f} degC{}{}", range->low, range->high,
                        is_measured ? "" : ", within 8 K of their mean", answer.battery_start_c ? "" : " of the air");
    if (is_measured && (packs.empty() || packs.front().may_be_several)) found.basis += ", if on one pack";
    apply(found, pack.battery);
    answer.resistance_at_ohm = known(found.ohm, std::move(found.basis));
    answer.resistance_at_interval_ohm = found.interval_ohm;
}

}  // namespace flightwatt::answer
