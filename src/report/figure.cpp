#include "report/figure.h"

#include "base/csv.h"

#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::report {
namespace {

std::string dumped(const VegaJson& json) {
    return json.dump(-1, ' ', false, VegaJson::error_handler_t::replace);
}

}  // namespace

FigureData::FigureData(std::initializer_list<std::string> numbers, std::initializer_list<std::string> texts)
    : numbers_(numbers) {
    std::vector<std::string> columns(numbers);
    columns.insert(columns.end(), texts);
    csv_ = fmt::format("{}", fmt::join(columns, ","));
}

void FigureData::add(std::initializer_list<double> numbers, std::initializer_list<std::string_view> texts) {
    std::string row;
    for (const double number : numbers) {
        if (std::isfinite(number)) fmt::format_to(std::back_inserter(row), "{:.6g}", number);
        row += ',';
    }
    for (const auto text : texts) row += csv_cell(valid_utf8(text)) + ",";
    row.pop_back();
    csv_ += "\n" + row;
    ++rows_;
}

VegaJson FigureData::format() const {
    VegaJson parse = VegaJson::object();
    for (const auto& name : numbers_) parse[name] = "number";
    return {{"type", "csv"}, {"parse", parse}};
}

VegaJson FigureData::json() const { return {{"values", csv_}, {"format", format()}}; }

VegaJson FigureData::reference(std::string_view name) const { return {{"name", name}, {"format", format()}}; }

VegaJson new_spec(const Figure& figure) {
    return {{"$schema", "https://vega.github.io/schema/vega-lite/v5.json"},
            {"description", valid_utf8(figure.description)}};
}

VegaJson quantity(std::string_view field, std::string_view title, const VegaJson& more) {
    VegaJson channel{{"field", field}, {"type", "quantitative"}, {"title", title}};
    channel.update(more);
    return channel;
}

VegaJson category(std::string_view field, std::string_view title, const VegaJson& more) {
    VegaJson channel{{"field", field}, {"type", "nominal"}, {"title", title}};
    channel.update(more);
    return channel;
}

VegaJson zoom_parameter(std::string_view channel) {
    // The wheel alone scrolls the page; a pinch on a touch pad is a wheel with Ctrl.
    return {{"name", "zoom"},
            {"bind", "scales"},
            {"select",
             {{"type", "interval"},
              {"encodings", {channel}},
              {"zoom", "wheel![event.ctrlKey || event.metaKey]"}}}};
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

VegaJson shown_by_legend() { return {{"filter", {{"param", "shown"}}}}; }

std::string valid_utf8(std::string_view text) {
    return VegaJson::parse(dumped(VegaJson(std::string(text)))).get<std::string>();
}

std::string script_json(const VegaJson& json) {
    const auto text = dumped(json);
    std::string safe;
    safe.reserve(text.size());
    for (const char c : text) {
        if (c == '<') {
            safe += "\\u003c";  // no </script> and no <!--
        } else {
            safe += c;
        }
    }
    return safe;
}

}  // namespace flightwatt::report
