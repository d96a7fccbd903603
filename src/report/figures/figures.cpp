#include "report/figures/figures.h"

#include "base/text.h"
#include "flight/flight_phases.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

namespace flightwatt::report {
namespace {

std::string word_of(const VegaJson& phase) {
    return std::string(phase_word(flight::phase_from(phase.get<std::string>()).value()));
}

/// An area between two columns; null for null.
VegaJson area_rows(const VegaJson& band) {
    if (band.is_null()) return nullptr;
    FigureData data({"time_s", "low_w", "high_w"});
    data.add_columns(band, {"time_s", "low_w", "high_w"});
    return data.json();
}

/// One column over time.
VegaJson rows_over_time(const VegaJson& part, const std::string& column) {
    FigureData data({"time_s", column});
    data.add_columns(part, {"time_s", column});
    return data.json();
}

/// Whether a column has a number.
bool has_number(const VegaJson& column) {
    return std::ranges::any_of(column, [](const VegaJson& cell) { return cell.is_number(); });
}

/// "(-0.2 to 0.4)".
std::string signed_interval(const VegaJson& interval) {
    return fmt::format("({:+.3g} to {:+.3g})", interval["low"].get<double>(), interval["high"].get<double>());
}

}  // namespace

Figure flight_figure(const std::string& flight, const VegaJson& detail, const std::string& id) {
    const auto templates = figure_template("flight")["vconcat"];  // for other tracks, and for power
    auto panels = VegaJson::array();
    auto views = VegaJson::array();
    const auto add_panel = [&](VegaJson panel, VegaJson values) {
        views.push_back(fmt::format("panel_{}", views.size()));
        values["name"] = views.back();
        panels.push_back(fill_template(std::move(panel), values));
    };
    const auto add_track = [&](const char* key, const char* column, const char* title, int height) {
        const auto& track = detail[key];
        if (track.is_null()) return;
        add_panel(templates[0],
                  {{"rows", rows_over_time(track, column)}, {"column", column}, {"title", title}, {"height", height}});
    };
    add_track("altitude", "altitude_m", "altitude [m]", 110);
    add_track("throttle", "throttle_percent", "throttle [%]", 80);
    const auto& power = detail["power"];
    FigureData curves({"time_s", "power_w"}, {"curve"});
    curves.add_columns(power, {"time_s", "power_w"}, {"measured"});
    if (!power["model_power_w"].is_null()) curves.add_columns(power, {"time_s", "model_power_w"}, {"model"});
    add_panel(templates[1], {{"rows", curves.json()}});
    FigureData phases({"start_s", "end_s"}, {"phase"});
    for (const auto& span : detail["phases"]) phases.add({span["start_s"], span["end_s"]}, {word_of(span["phase"])});
    FigureData edges({"time_s"}, {"edge", "evidence"});
    for (const auto& edge : detail["edges"]) edges.add({edge["time_s"]}, {edge["name"], edge["evidence"]});
    auto figure = new_figure(
        "flight", id, fmt::format("Altitude, throttle and power of flight {} over time, with its phases.", flight),
        {{"views", views}, {"power_view", views.back()}, {"phases", phases.csv()}, {"edges", edges.csv()}});
    figure.spec["vconcat"] = panels;
    return figure;
}

Figure model_figure(const VegaJson& model, const std::string& id) {
    auto drawn = VegaJson::array({"model"});
    const auto& cruise = model["curves"][1];
    if (!cruise["band"].is_null()) drawn.push_back("95 % band");
    if (!cruise["flights"].is_null()) drawn.push_back("range of the flights");
    VegaJson legend = nullptr;
    if (drawn.size() > 1) legend = {{"values", drawn}, {"symbolType", "square"}, {"symbolOpacity", 1}, {"columns", 3}};
    auto panels = VegaJson::array();
    for (const auto& curve : model["curves"])
        panels.push_back({{"phase", word_of(curve["phase"])},
                          {"legend", legend},
                          {"envelope", area_rows(curve["flights"])},
                          {"band", area_rows(curve["band"])},
                          {"model", rows_over_time(curve, "power_w")}});
    return new_figure(
        "model", id, fmt::format("Mechanical power model {} over each phase.", model["fit"]["name"].get<std::string>()),
        {{"panels", panels}});
}

Figure physical_figure(const VegaJson& physical, const std::string& id) {
    FigureData level({"airspeed_m_per_s", "power_w", "low_w", "high_w"}, {"range"});
    double drawn_from = std::numeric_limits<double>::infinity();
    for (const auto& part : physical["level"]) {
        level.add_columns(part, {"airspeed_m_per_s", "power_w", "low_w", "high_w"},
                          {part["flown"] ? "flown" : "slower than flown"});
        drawn_from = std::min(drawn_from, part["airspeed_m_per_s"].front().get<double>());
    }
    FigureData bins({"airspeed_m_per_s", "power_w", "climb_m_per_s", "measured_w", "start_s"}, {"flight"});
    for (const auto& flight : physical["bins"])
        bins.add_columns(flight, {"airspeed_m_per_s", "level_power_w", "climb_m_per_s", "power_w", "start_s"},
                         {flight["flight"]});
    const auto& fit = physical["fit"];
    auto description = fmt::format("Power over airspeed in level flight, with {} bins of {} flights.",
                                   fit["bins"].get<int>(), fit["flights"].size());
    FigureData best({"airspeed_m_per_s", "power_w", "low_m_per_s", "high_m_per_s"}, {"purpose"});
    for (const auto& speed : physical["best"]) {
        const auto& airspeed = speed["airspeed_m_per_s"];
        best.add({airspeed.is_null() ? std::nan("") : airspeed.get<double>(), speed["power_w"], speed["low_m_per_s"],
                  speed["high_m_per_s"]},
                 {speed["purpose"]});
        description += fmt::format(" {}: {}.", speed["purpose"].get<std::string>(), speed["text"].get<std::string>());
    }
    const auto& flown = fit["airspeed_m_per_s"];
    return new_figure("physical", id, description,
                      {{"level", level.json()},
                       {"bins", bins.json()},
                       {"best", best.empty() ? VegaJson() : best.json()},
                       {"flown", {{"values", {flown}}}},
                       {"domain", {drawn_from, flown["high"]}}});
}

Figure validation_figure(const VegaJson& validation, const std::string& id) {
    FigureData data({"error_wh", "measured_wh", "predicted_wh"}, {"model", "flight"});
    for (const auto& of_model : validation["errors"])
        data.add_columns(of_model, {"error_wh", "measured_wh", "predicted_wh"},
                         {of_model["title"], of_model["flight"]});
    return new_figure("validation", id,
                      fmt::format("Error of the predicted energy of {} flights by leave-one-out.",
                                  validation["scores"]["flights"].get<int>()),
                      {{"errors", data.json()}});
}

Figure voltage_figure(const VegaJson& battery, const std::string& id) {
    const auto& voltages = battery["voltages"];
    auto description = fmt::format("Terminal voltage of {} flights over time, measured and modelled.", voltages.size());
    auto panels = VegaJson::array();
    for (const auto& flight : voltages) {
        const auto name = flight["flight"].get<std::string>();
        double low = std::numeric_limits<double>::infinity();
        double high = 0.0;
        for (const auto& volt : flight["measured_v"]) {
            if (volt.is_null()) continue;
            low = std::min(low, volt.get<double>());
            high = std::max(high, volt.get<double>());
        }
        description += fmt::format(" {}: {:.2f} to {:.2f} V.", name, low, high);
        FigureData curves({"time_s", "voltage_v"}, {"curve"});
        curves.add_columns(flight, {"time_s", "measured_v"}, {"measured"});
        curves.add_columns(flight, {"time_s", "model_v"}, {"model"});
        panels.push_back({{"curves", curves.json()}, {"flight", valid_utf8(name)}});
    }
    return new_figure("voltage", id, description, {{"panels", panels}});
}

Figure open_circuit_figure(const VegaJson& battery, const std::string& id) {
    const auto& knots = battery["open_circuit"];
    auto origins = VegaJson::array();
    for (const auto& from_flights : knots["from_flights"])
        origins.push_back(from_flights ? "from flights" : "by the chart");
    FigureData data({"soc_percent", "voltage_v", "low_v", "high_v"}, {"origin"});
    data.add_columns(knots, {"soc_percent", "voltage_v", "low_v", "high_v"}, {origins});
    auto figure = new_figure(
        "open_circuit", id,
        fmt::format(
            "Open-circuit voltage over state of charge: {:.2f} V empty, {:.2f} V full, observed down to {:.0f} %.",
            knots["voltage_v"].front().get<double>(), knots["voltage_v"].back().get<double>(),
            battery["identified"]["open_circuit"]["known_down_to_percent"].get<double>()),
        {{"knots", data.json()}});
    if (!has_number(knots["low_v"])) figure.spec["layer"].erase(0);  // the intervals
    return figure;
}

Figure profile_figure(const VegaJson& software, const std::string& id) {
    auto figure = new_figure("profile", id, "Profiled power of on-board software over its quality of service.");
    const auto panel_template = figure.spec["concat"][0];
    auto panels = VegaJson::array();
    for (const auto& component : software["components"]) {
        const auto& lines = component["lines"];
        auto panel = panel_template;
        auto& nodes = panel["layer"][0];
        auto& tooltip = nodes["encoding"]["tooltip"];  // power over the parameter, further parameters, error
        tooltip.erase(3);
        if (!has_number(lines[0]["low_w"])) nodes["layer"].erase(1);
        if (lines[0]["name"] == "") {
            tooltip.erase(2);
            nodes["encoding"].erase("color");
        }
        FigureData data({"qos", "power_w", "low_w", "high_w"}, {"line"});
        for (const auto& line : lines) data.add_columns(line, {"value", "power_w", "low_w", "high_w"}, {line["name"]});
        const auto parameter = component["parameter"].get<std::string>();
        panels.push_back(fill_template(std::move(panel), {{"nodes", data.json()},
                                                          {"parameter", parameter.empty() ? "no parameter" : parameter},
                                                          {"component", component["name"]}}));
    }
    figure.spec["concat"] = panels;
    return figure;
}

Figure schedule_figure(const VegaJson& missions, const std::string& id) {
    const auto& phases = missions.front()["phases"];
    const bool are_common =
        std::ranges::all_of(missions, [&](const VegaJson& mission) { return mission["phases"] == phases; });
    double end_s = 0.0;
    auto titles = VegaJson::array();
    auto shown = VegaJson::array();
    auto curves = VegaJson::array();
    FigureData strip({"start_s", "end_s", "compute_w"}, {"mission", "phase", "runs"});
    std::string description = "State of charge over the mission.";
    bool has_software = false;
    for (const auto& mission : missions) {
        const auto& title = mission["title"];
        const auto& band = mission["band"];
        end_s = std::max(end_s, mission["summary"]["duration_s"].get<double>());
        titles.push_back(title);
        shown.push_back({{"title", title}});
        curves.push_back({{"title", title},
                          {"time_s", mission["curve"]["time_s"]},
                          {"soc", mission["curve"]["soc_percent"]},
                          {"reserve", mission["summary"]["reserve_soc_percent"]},
                          {"band", band.is_null() ? band
                                                  : VegaJson{{"time_s", band["time_s"]},
                                                             {"low", band["low_percent"]},
                                                             {"high", band["high_percent"]}}}});
        description += fmt::format(" {}: {}.", title.get<std::string>(), mission["card"]["lead"].get<std::string>());
        for (const auto& part : mission["schedule"]) {
            strip.add({part["start_s"], part["end_s"], part["compute_w"]},
                      {title, word_of(part["phase"]), part["runs"]});
            has_software = has_software || part["compute_w"] != 0.0;
        }
    }
    auto common = VegaJson::array();
    for (const auto& phase : phases)
        common.push_back(
            {{"phase", word_of(phase["phase"])}, {"start_s", phase["start_s"]}, {"end_s", phase["end_s"]}});
    auto figure = new_figure("schedule", id, description,
                             {{"end_s", end_s},
                              {"titles", titles},
                              {"shown", shown},
                              {"missions", curves},
                              {"phases", are_common ? VegaJson{{"values", common}} : VegaJson()},
                              {"strip", strip.json()}});
    if (!has_software) figure.spec["vconcat"].erase(1);
    return figure;
}

Figure quality_figure(const QosMap& map, const std::string& id) {
    FigureData data({"x_low", "x_high", "y_low", "y_high", "soc_percent"});
    for (std::size_t j = 0; j + 1 < map.y.nodes.size(); ++j) {
        for (std::size_t i = 0; i + 1 < map.x.nodes.size(); ++i) {
            const double soc = (map.at(i, j) + map.at(i + 1, j) + map.at(i, j + 1) + map.at(i + 1, j + 1)) / 4.0;
            data.add({map.x.nodes[i], map.x.nodes[i + 1], map.y.nodes[j], map.y.nodes[j + 1], soc});
        }
    }
    const auto x = valid_utf8(map.x.name);
    const auto y = valid_utf8(map.y.name);
    return new_figure(
        "quality", id,
        fmt::format("Final state of charge over {} and {}, where one configuration runs throughout.", x, y),
        {{"x", x},
         {"x_from", x + " from"},
         {"x_domain", {map.x.nodes.front(), map.x.nodes.back()}},
         {"y", y},
         {"y_from", y + " from"},
         {"y_domain", {map.y.nodes.front(), map.y.nodes.back()}},
         {"cells", data.json()}});
}

Figure trends_figure(const VegaJson& trends, const std::string& aircraft, const std::string& id) {
    constexpr double ms_per_s = 1000.0;
    constexpr double relative_margin = 0.05;  // of equal values
    auto description = "Trends of " + aircraft + " and its pack over the dates of flights.";
    auto panels = VegaJson::array();
    const auto add = [&](FigureData& data, const VegaJson& part, const std::vector<std::string>& texts) {
        for (std::size_t i = 0; i < part["value"].size(); ++i)
            data.add({part["clock_s"][i].get<double>() * ms_per_s, part["value"][i]}, texts);
    };
    for (const auto& trend : trends["trends"]) {
        if (trend["aircraft"] != aircraft || trend["lines"].is_null()) continue;
        const auto title = trend["title"].get<std::string>();
        description +=
            fmt::format(" {}: {:.3g}, {:+.3g} in 30 days {}, {}.", title, trend["median"].get<double>(),
                        trend["change_in_30_days"].get<double>(),
                        signed_interval(trend["change_in_30_days_interval_95"]), trend["direction"].get<std::string>());
        FigureData flights({"date", "value"});
        add(flights, trend["flights"], {});
        FigureData slopes({"date", "value"}, {"slope"});
        for (const auto& line : trend["lines"]) add(slopes, line, {line["name"]});
        // The interval of few flights is cut: it would hide them.
        const auto values = trend["flights"]["value"].get<std::vector<double>>();
        const auto [low, high] = std::ranges::minmax(values);
        const double margin = std::max(high - low, relative_margin * std::abs(high));
        panels.push_back({{"flights", flights.json()},
                          {"slopes", slopes.json()},
                          {"domain", {low - margin, high + margin}},
                          {"title", title}});
    }
    return new_figure("trends", id, description, {{"panels", panels}});
}

}  // namespace flightwatt::report
