#include "report/figures/flight_figures.h"

#include <algorithm>

#include <fmt/format.h>

namespace flightwatt::report {
namespace {

constexpr int in_flight_width = 640;
constexpr int in_flight_height = 190;
constexpr auto in_flight_time_title = "time since lift-off [s]";
constexpr auto in_flight_energy_title = "energy of the whole flight [Wh]";

}  // namespace

Figure in_flight_figure(const std::string& name, const PredictedFlight& flight, const std::string& id) {
    FigureData data({"flown_s", "energy_wh", "low_wh", "high_wh", "measured_wh"});
    std::size_t held = 0;
    for (const auto& [flown_s, energy_wh, interval] : flight.moments) {
        data.add({flown_s, energy_wh, interval.low_wh, interval.high_wh, flight.measured_wh});
        if (interval.contains(flight.measured_wh)) ++held;
    }
    const auto& first = flight.moments.front();
    const auto& last = flight.moments.back();
    auto figure = new_figure(
        id,
        fmt::format(
            "What flightwatt predict would have said in every minute of the cruise, from what was flown until then "
            "and a model of the {} other flights; the durations of cruise and landing taken as known. Level line: "
            "measured. {} of {} intervals of 95 % hold it (neighbours share what they rest on).",
            flight.others, held, flight.moments.size()),
        fmt::format(
            "Predicted energy of flight {}: {:.2f} Wh after {:.0f} s, {:.2f} Wh after {:.0f} s; measured {:.2f} Wh.",
            name, first.energy_wh, first.flown_s, last.energy_wh, last.flown_s, flight.measured_wh));
    figure.spec["data"] = data.json();
    figure.spec["width"] = in_flight_width;
    figure.spec["height"] = in_flight_height;
    const auto time = numeric_channel("flown_s", in_flight_time_title, {{"scale", {{"nice", false}}}});
    const VegaJson energy{{"scale", {{"zero", false}}}};
    figure.spec["layer"] = {
        layer(R"({"type": "area", "style": "measured", "opacity": 0.2, "aria": false})",
              {{"x", time},
               {"y", numeric_channel("low_wh", in_flight_energy_title, energy)},
               {"y2", {{"field", "high_wh"}}}}),
        layer(R"({"type": "line", "style": "edge", "aria": false})",
              {{"x", time}, {"y", numeric_channel("measured_wh", in_flight_energy_title, energy)}}),
        layer(R"({"type": "line", "style": "measured", "point": {"size": 26}})",
              {{"x", time},
               {"y", numeric_channel("energy_wh", in_flight_energy_title, energy)},
               {"tooltip",
                {tooltip_number("flown_s", in_flight_time_title, ".0f"),
                 tooltip_number("energy_wh", "predicted [Wh]", ".3f"), tooltip_number("low_wh", "low [Wh]", ".3f"),
                 tooltip_number("high_wh", "high [Wh]", ".3f"),
                 tooltip_number("measured_wh", "measured [Wh]", ".3f")}}})};
    return figure;
}

}  // namespace flightwatt::report
