#include "report/figure.h"

#include "base/csv.h"
#include "base/number.h"
#include "base/text.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include <boost/algorithm/string/replace.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::report {
namespace {

std::string dumped(const VegaJson& json) { return json.dump(-1, ' ', false, VegaJson::error_handler_t::replace); }

VegaJson channel_of(std::string_view field, std::string_view type, std::string_view title, const VegaJson& more) {
    VegaJson channel{{"field", field}, {"type", type}, {"title", title}};
    channel.update(more);
    return channel;
}

/// The nearest number of so many decimals; never -0.
double rounded(double number, int decimals) {
    const double scale = std::pow(10.0, decimals);
    return std::round(number * scale) / scale + 0.0;
}

PublishedCurve read_curve(const std::filesystem::path& path, std::string_view value) {
    const auto table = read_csv(path);
    const auto time_at = column_index(table, "time_s");
    const auto value_at = column_index(table, value);
    PublishedCurve curve;
    for (const auto& row : table.rows) {
        curve.time_s.push_back(cell_number(table, row, time_at));
        curve.value.push_back(cell_number(table, row, value_at));
    }
    return curve;
}

std::vector<PublishedCell> read_cells(const std::filesystem::path& path) {
    const auto table = read_csv(path);
    const auto number = [&](const CsvTable::Row& row, std::string_view name) {
        return cell_number(table, row, column_index(table, name));
    };
    std::vector<PublishedCell> cells;
    for (const auto& row : table.rows) {
        cells.push_back({number(row, "fps_low"), number(row, "fps_high"), number(row, "key_bits_low"),
                         number(row, "key_bits_high"), number(row, "soc_percent")});
    }
    return cells;
}

}  // namespace

int decimals_for(std::span<const double> values, double steps, int least) {
    double lowest = std::numeric_limits<double>::infinity();
    double highest = -lowest;
    for (const double value : values) {
        if (!std::isfinite(value)) continue;
        lowest = std::min(lowest, value);
        highest = std::max(highest, value);
    }
    constexpr int most = 9;  // what rounds itself has no digits behind
    if (!(highest > lowest)) return std::max(least, 3);
    return std::clamp(static_cast<int>(std::ceil(-std::log10((highest - lowest) / steps))), least, most);
}

Figure new_figure(std::string id, std::string caption, std::string description) {
    VegaJson spec{{"$schema", "https://vega.github.io/schema/vega-lite/v5.json"},
                  {"description", valid_utf8(description)}};
    return {std::move(id), std::move(caption), std::move(description), std::move(spec)};
}

FigureData::FigureData(std::initializer_list<std::string> numbers, std::initializer_list<std::string> texts)
    : numbers_(numbers) {
    std::vector<std::string> columns(numbers);
    columns.insert(columns.end(), texts);
    csv_ = fmt::format("{}", fmt::join(columns, ","));
}

void FigureData::add(std::initializer_list<double> numbers, std::initializer_list<std::string_view> texts) {
    std::string row;
    std::size_t column = 0;
    for (const double number : numbers) {
        if (std::isfinite(number)) {
            if (decimals_.empty()) {
                fmt::format_to(std::back_inserter(row), "{:.6g}", number);
            } else {
                std::array<char, number_buffer_size> text{};
                row.append(text.data(), write_number(text.data(), rounded(number, decimals_.at(column))));
            }
        }
        row += ',';
        ++column;
    }
    for (const auto text : texts) row.append(csv_cell(valid_utf8(text))).append(",");
    row.pop_back();
    csv_.append("\n").append(row);
    ++rows_;
}

VegaJson FigureData::format() const {
    VegaJson parse = VegaJson::object();
    for (const auto& name : numbers_) parse[name] = "number";
    return {{"type", "csv"}, {"parse", parse}};
}

VegaJson FigureData::json() const { return {{"values", csv_}, {"format", format()}}; }

VegaJson FigureData::reference(std::string_view name) const { return {{"name", name}, {"format", format()}}; }

std::vector<std::size_t> downsample_m4(const std::vector<double>& time_s, const std::vector<double>& values,
                                       std::size_t columns) {
    constexpr std::size_t rows_per_column = 4;
    std::vector<std::size_t> rows(time_s.size());
    std::iota(rows.begin(), rows.end(), std::size_t{0});
    if (rows.size() <= rows_per_column * columns) return rows;
    const double duration_s = time_s.back() - time_s.front();
    const auto column_of = [&](std::size_t i) {
        const double part = (time_s[i] - time_s.front()) / duration_s;
        return std::min(columns - 1, static_cast<std::size_t>(part * static_cast<double>(columns)));
    };
    std::vector<std::size_t> kept;
    for (auto first = rows.begin(); first != rows.end();) {
        const auto end =
            std::find_if(first, rows.end(), [&](std::size_t i) { return column_of(i) != column_of(*first); });
        const auto [least, greatest] =
            std::minmax_element(first, end, [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });
        std::vector<std::size_t> chosen{*first, *least, *greatest, *std::prev(end)};
        std::ranges::sort(chosen);
        std::ranges::unique_copy(chosen, std::back_inserter(kept));
        first = end;
    }
    return kept;
}

VegaJson vega(std::string_view text) { return VegaJson::parse(text); }

VegaJson layer(const VegaJson& data, std::string_view mark, const VegaJson& encoding) {
    return {{"data", data}, {"mark", vega(mark)}, {"encoding", encoding}};
}

VegaJson layer(std::string_view mark, const VegaJson& encoding) {
    return {{"mark", vega(mark)}, {"encoding", encoding}};
}

VegaJson numeric_channel(std::string_view field, std::string_view title, const VegaJson& more) {
    return channel_of(field, "quantitative", title, more);
}

VegaJson nominal_channel(std::string_view field, std::string_view title, const VegaJson& more) {
    return channel_of(field, "nominal", title, more);
}

VegaJson tooltip_number(std::string_view field, std::string_view title, std::string_view format) {
    return numeric_channel(field, title, {{"format", format}});
}

void add_measured_and_model(VegaJson& encoding, double measured_px, double model_px) {
    const auto legend = vega(R"({"symbolType": "stroke"})");
    auto scale = vega(R"({"domain": ["measured", "model"], "range": "measured_and_model"})");
    encoding["color"] = nominal_channel("curve", "", {{"scale", scale}, {"legend", legend}});
    scale["range"] = {measured_px, model_px};
    encoding["strokeWidth"] = channel_of("curve", "ordinal", "", {{"scale", scale}, {"legend", legend}});
}

VegaJson power_ramp(std::string_view field, std::string_view title) {
    return numeric_channel(field, title, vega(R"({"scale": {"range": "ramp"},
        "legend": {"orient": "bottom", "gradientLength": 160}})"));
}

void set_panels(Figure& figure, int columns, int row_gap_px, const VegaJson& panels) {
    figure.spec["columns"] = columns;
    figure.spec["bounds"] = "flush";
    figure.spec["spacing"] = {{"column", 62}, {"row", row_gap_px}};
    figure.spec["concat"] = panels;
}

VegaJson panel_name(std::string_view name) {
    auto mark = vega(R"({"type": "text", "style": "panel-name", "x": 0, "y": -12, "align": "left",
                         "baseline": "alphabetic", "limit": 260, "aria": false})");
    mark["text"] = valid_utf8(name);
    return {{"data", {{"values", {VegaJson::object()}}}}, {"mark", mark}};
}

VegaJson add_zoom(Figure& figure, const VegaJson& views) {
    figure.time_signal = "zoom_time_s";
    figure.time_scale = "x";
    // The wheel alone scrolls the page; a pinch on a touch pad is a wheel with Ctrl.
    auto zoom = vega(R"({"name": "zoom", "bind": "scales", "select":
        {"type": "interval", "encodings": ["x"], "zoom": "wheel![event.ctrlKey || event.metaKey]"}})");
    zoom["views"] = views;
    return zoom;
}

VegaJson legend_parameter(std::string_view field, const VegaJson& series, std::string_view view) {
    auto all = VegaJson::array();
    for (const auto& name : series) all.push_back({{std::string(field), name}});
    return {{"name", "shown"},
            {"bind", "legend"},
            {"value", all},
            {"select", {{"type", "point"}, {"fields", {field}}, {"toggle", "true"}}},
            {"views", {view}}};
}

VegaJson shown_by_legend() { return vega(R"({"filter": {"param": "shown"}})"); }

VegaJson phase_names(const VegaJson& data, std::string_view time_title) {
    return layer(data, R"({"type": "text", "style": "note", "baseline": "bottom", "dy": -3, "y": 0, "clip": false})",
                 {{"x", numeric_channel("middle_s", time_title)}, {"text", nominal_channel("word", "phase")}});
}

std::string script_json(const VegaJson& json) {
    return boost::replace_all_copy(dumped(json), "<", "\\u003c");  // no </script> and no <!--
}

PublishedFigures read_published_figures(const std::filesystem::path& folder) {
    PublishedFigures figures;
    for (const auto phase : flight::all_phases) {
        figures.power[phase] = read_curve(folder / fmt::format("fig2_{}.csv", to_string(phase)), "power_w");
    }
    for (const auto* mission : {"mechanical-only", "invariant-5.8fps-32bit", "invariant-10fps-240bit",
                                "invariant-32fps-448bit", "phased", "adaptive"}) {
        auto name = std::string("fig3_") + mission + ".csv";
        std::ranges::replace(name, '-', '_');
        figures.soc[mission] = read_curve(folder / name, "soc_percent");
    }
    figures.soc_cells = read_cells(folder / "fig4_soc_cells.csv");
    return figures;
}

}  // namespace flightwatt::report
