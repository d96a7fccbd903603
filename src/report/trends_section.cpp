#include "report/trends_section.h"

#include "base/statistics.h"

#include <algorithm>

#include <fmt/format.h>

namespace flightwatt::report {
namespace {

constexpr double ms_per_day = 86400.0 * 1000.0;

std::string title_of(const AircraftTrend& trend) {
    const auto all = trend_quantities();
    const std::string title = std::ranges::find(all, trend.quantity, &TrendQuantity::name)->title;
    return trend.level_is_guess ? title + ", level a guess" : title;
}

VegaJson date_axis() {
    return {{"field", "date"}, {"type", "temporal"}, {"title", "date"}, {"scale", {{"type", "utc"}}}};
}

/// Flights as points; the slope as a line through their middle, and beside it the ends of its interval.
VegaJson trend_panel(const AircraftTrend& trend) {
    const auto title = title_of(trend);
    FigureData flights({"date", "value"});
    flights.round_to({0, 6});
    std::vector<double> days;
    for (const auto& [day, value] : trend.values) {
        flights.add({day * ms_per_day, value});
        days.push_back(day);
    }
    const auto& told = *trend.answer.trend;
    const double middle_day = median(days);
    const auto range = std::ranges::minmax(days);
    std::vector<double> from_middle;
    for (const auto& [day, value] : trend.values) from_middle.push_back(value - told.per_day * (day - middle_day));
    const double middle = median(std::move(from_middle));
    FigureData slopes({"date", "value"}, {"slope"});
    slopes.round_to({0, 6});
    const auto add_line = [&](double per_day, std::string_view name) {
        for (const double day : {range.min, range.max})
            slopes.add({day * ms_per_day, middle + per_day * (day - middle_day)}, {name});
    };
    add_line(told.per_day, "median slope");
    add_line(told.low_per_day, "low, 95 %");
    add_line(told.high_per_day, "high, 95 %");
    const VegaJson y = numeric_channel("value", "", {{"scale", {{"zero", false}}}});
    const VegaJson points = layer(
        flights.json(), R"({"type": "point", "size": 40, "filled": true, "opacity": 1})",
        {{"x", date_axis()},
         {"y", y},
         {"tooltip",
          {{{"field", "date"}, {"type", "temporal"}, {"title", "date"}, {"formatType", "utc"}, {"format", "%Y-%m-%d"}},
           tooltip_number("value", title, ".4g")}}});
    const VegaJson dash{
        {"field", "slope"},
        {"type", "nominal"},
        {"title", "slope"},
        {"scale", {{"domain", {"median slope", "low, 95 %", "high, 95 %"}}, {"range", {{1, 0}, {4, 3}, {4, 3}}}}},
        {"legend", nullptr}};
    const VegaJson lines = layer(slopes.json(), R"({"type": "line", "style": "measured"})",
                                 {{"x", date_axis()}, {"y", y}, {"strokeDash", dash}});
    return {{"width", 280}, {"height", 150}, {"layer", {lines, points, panel_name(title)}}};
}

/// Of one aircraft, the quantities whose trend is told.
Figure trend_figure(std::span<const AircraftTrend> trends, const std::string& aircraft, const std::string& id) {
    auto description = "How " + aircraft + " and its pack go over the dates of flights.";
    auto panels = VegaJson::array();
    for (const auto& trend : trends) {
        if (trend.aircraft != aircraft || !trend.answer.trend) continue;
        const auto [slope, low, high, unit] = shown_slope(trend);
        description +=
            fmt::format(" {}: {:.3g}, {:+.3g}{} in 30 days ({:+.3g}{} to {:+.3g}{}), {}.", title_of(trend),
                        trend.answer.trend->median, slope, unit, low, unit, high, unit, trend_direction(trend));
        panels.push_back(trend_panel(trend));
    }
    auto figure = new_figure(
        id,
        "Energy by time, and by distance over ground and through the air; the mean power of cruises; "
        "resistance and capacity of the pack. Each point is a flight; the line has the median of the slopes between all pairs of flights, "
        "the dashed ones the ends of its 95 % interval.",
        description);
    set_panels(figure, 2, 66, panels);
    return figure;
}

}  // namespace

std::optional<Section> trends_section(std::span<const AircraftTrend> trends) {
    std::vector<std::string> aircraft;
    for (const auto& trend : trends)
        if (trend.answer.trend && std::ranges::find(aircraft, trend.aircraft) == aircraft.end())
            aircraft.push_back(trend.aircraft);
    if (aircraft.empty()) return std::nullopt;
    Section section{"trends", "Trends"};
    section.html += paragraph(
        "How aircraft and packs go over the dates of their flights. A trend is told by an interval without 0; one in 20 "
        "shows by chance, and wind, season and the pack that was flown go into it like age.");
    for (const auto& name : aircraft) {
        if (aircraft.size() > 1) section.html += "<h3>" + html_escaped(name) + "</h3>\n";
        add_figure(section, trend_figure(trends, name, fmt::format("trends-{}", section.figures.size() + 1)));
    }
    section.html += table_html(trend_table(trends), {"Trends over the dates of flights", true, {}});
    return section;
}

}  // namespace flightwatt::report
