#include "report/figure.h"

#include "base/csv.h"
#include "base/text.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>

#include <boost/algorithm/string/replace.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::report {
namespace {

/// The nearest number with `decimals` decimals; never -0.
double rounded(double number, int decimals) {
    const double scale = std::pow(10.0, decimals);
    return std::round(number * scale) / scale + 0.0;
}

}  // namespace

VegaJson figure_template(std::string_view name) { return VegaJson::parse(web_templates().at(name)); }

VegaJson fill_template(VegaJson part, const VegaJson& values) {
    if (part.is_string()) {
        const std::string_view text = part.get_ref<const std::string&>();
        if (!text.starts_with("{{") || !text.ends_with("}}")) return part;
        const std::string field(text.substr(2, text.size() - 4));
        return values.contains(field) ? values[field] : part;
    }
    if (!part.is_structured()) return part;
    for (auto& inner : part) inner = fill_template(std::move(inner), values);
    if (!part.is_array()) return part;
    std::erase_if(part.get_ref<VegaJson::array_t&>(), [](const VegaJson& layer) {
        return layer.is_object() && layer.contains("data") && layer["data"].is_null();
    });
    return part;
}

Figure new_figure(std::string_view name, std::string id, std::string caption, std::string description,
                  const VegaJson& values) {
    auto spec = fill_template(figure_template(name), values);
    if (values.contains("panels")) {
        const auto panel = spec["concat"][0];
        spec["concat"].clear();
        for (const auto& of_panel : values["panels"]) spec["concat"].push_back(fill_template(panel, of_panel));
    }
    spec["description"] = valid_utf8(description);
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
                fmt::format_to(std::back_inserter(row), "{}", rounded(number, decimals_.at(column)));
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

VegaJson FigureData::json() const {
    auto parse = VegaJson::object();
    for (const auto& name : numbers_) parse[name] = "number";
    return {{"values", csv_}, {"format", {{"type", "csv"}, {"parse", parse}}}};
}

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
        const auto [min_at, max_at] =
            std::minmax_element(first, end, [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });
        std::vector<std::size_t> chosen{*first, *min_at, *max_at, *std::prev(end)};
        std::ranges::sort(chosen);
        std::ranges::unique_copy(chosen, std::back_inserter(kept));
        first = end;
    }
    return kept;
}

std::string script_json(const VegaJson& json) {
    const auto text = json.dump(-1, ' ', false, VegaJson::error_handler_t::replace);
    return boost::replace_all_copy(text, "<", "\\u003c");  // no </script> and no <!--
}

}  // namespace flightwatt::report
