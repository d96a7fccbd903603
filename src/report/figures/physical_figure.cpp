#include "base/utf8.h"
#include "report/figures/flight_figures.h"

#include <algorithm>

#include <fmt/format.h>

namespace flightwatt::report {
namespace {

constexpr int points_of_line = 41;
constexpr auto airspeed_title = "airspeed [m/s]";
constexpr auto motion_power_title = "power [W]";

FigureData stretch_rows(std::span<const mechanical::BinnedFlight> flights) {
    FigureData data({"airspeed_m_per_s", "power_w", "climb_m_per_s", "start_s"}, {"flight"});
    for (const auto& flight : flights) {
        for (const auto& bin : flight.bins) {
            data.add({bin.airspeed_m_per_s, bin.power_w, bin.values[mechanical::PowerTerm::climb], bin.start_s},
                     {valid_utf8(flight.flight)});
        }
    }
    return data;
}

/// The climbs that are drawn: level, and half of what was flown to both sides.
std::vector<double> drawn_climbs(const mechanical::PhysicalModel& model) {
    std::vector<double> climbs{0.0};
    if (model.climb_m_per_s.low < 0.0) climbs.insert(climbs.begin(), 0.5 * model.climb_m_per_s.low);
    if (model.climb_m_per_s.high > 0.0) climbs.push_back(0.5 * model.climb_m_per_s.high);
    return climbs;
}

FigureData line_rows(const mechanical::PhysicalModel& model) {
    FigureData data({"airspeed_m_per_s", "power_w", "climb_m_per_s"}, {"line"});
    const auto& range = model.airspeed_m_per_s;
    for (const double climb : drawn_climbs(model)) {
        for (int i = 0; i < points_of_line; ++i) {
            const double airspeed = range.low + (range.high - range.low) * i / (points_of_line - 1);
            if (!(airspeed > 0.0)) continue;
            data.add({airspeed, power_w(model, {airspeed, climb}), climb}, {fmt::format("{:+.1f} m/s", climb)});
        }
    }
    return data;
}

std::string motion_described(const mechanical::PhysicalModel& model) {
    std::string text = fmt::format("Power over airspeed of {} stretches of {} flights, and the model.", model.bins,
                                   model.flights.size());
    for (const double climb : drawn_climbs(model)) {
        const auto& range = model.airspeed_m_per_s;
        text += fmt::format(" Climbing {:+.1f} m/s: {:.1f} W at {:.1f} m/s, {:.1f} W at {:.1f} m/s.", climb,
                            power_w(model, {std::max(range.low, 0.1), climb}), range.low,
                            power_w(model, {range.high, climb}), range.high);
    }
    return text;
}

VegaJson climb_color() {
    return numeric_channel(
        "climb_m_per_s", "climb [m/s]",
        {{"scale", {{"scheme", "blueorange"}, {"domainMid", 0}}}, {"legend", {{"orient", "right"}}}});
}

}  // namespace

Figure physical_figure(const mechanical::PhysicalModel& model, std::span<const mechanical::BinnedFlight> flights,
                       const std::string& id) {
    auto figure =
        new_figure(id,
                   "Power over airspeed. A ring is a stretch of a flight of about 30 s; lines are the model in "
                   "level flight, climbing and descending. The colour is the climb.",
                   motion_described(model));
    const auto x = numeric_channel("airspeed_m_per_s", airspeed_title, {{"scale", {{"zero", false}}}});
    const auto y = numeric_channel("power_w", motion_power_title);
    figure.spec["width"] = 560;
    figure.spec["height"] = 360;
    figure.spec["layer"] = {
        layer(stretch_rows(flights).json(), R"({"type": "point", "size": 40, "opacity": 0.8})",
              {{"x", x},
               {"y", y},
               {"color", climb_color()},
               {"tooltip",
                {nominal_channel("flight", "flight"), tooltip_number("start_s", "from [s]", ".0f"),
                 tooltip_number("airspeed_m_per_s", "airspeed [m/s]", ".2f"),
                 tooltip_number("climb_m_per_s", "climb [m/s]", "+.2f"),
                 tooltip_number("power_w", "measured [W]", ".2f")}}}),
        layer(line_rows(model).json(), R"({"type": "line", "strokeWidth": 2})",
              {{"x", x},
               {"y", y},
               {"color", climb_color()},
               {"detail", {{"field", "line"}, {"type", "nominal"}}},
               {"tooltip",
                {nominal_channel("line", "model, climbing"), tooltip_number("power_w", "power [W]", ".2f")}}})};
    return figure;
}

}  // namespace flightwatt::report
