#include "report/figure.h"

#include "base/csv.h"
#include "base/text.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::report {

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

Figure new_figure(std::string_view name, std::string id, std::string description, const VegaJson& values) {
    auto spec = fill_template(figure_template(name), values);
    if (values.contains("panels")) {
        const auto panel = spec["concat"][0];
        spec["concat"].clear();
        for (const auto& of_panel : values["panels"]) spec["concat"].push_back(fill_template(panel, of_panel));
    }
    spec["description"] = valid_utf8(description);
    return {std::move(id), std::move(description), std::move(spec)};
}

FigureData::FigureData(std::initializer_list<std::string> numbers, std::initializer_list<std::string> texts)
    : numbers_(numbers) {
    std::vector<std::string> columns(numbers);
    columns.insert(columns.end(), texts);
    csv_ = fmt::format("{}", fmt::join(columns, ","));
}

void FigureData::add(const std::vector<double>& numbers, const std::vector<std::string>& texts) {
    std::string row;
    for (const double number : numbers) {
        constexpr double max_of_digits = 1e7;  // larger: times [ms]
        if (std::abs(number) < max_of_digits)
            fmt::format_to(std::back_inserter(row), "{:.7g}", number + 0.0);
        else if (std::isfinite(number))
            fmt::format_to(std::back_inserter(row), "{:.0f}", number);
        row += ',';
    }
    for (const auto& text : texts) row.append(csv_cell(valid_utf8(text))).append(",");
    row.pop_back();
    csv_.append("\n").append(row);
    ++rows_;
}

void FigureData::add_columns(const VegaJson& part, const std::vector<std::string>& keys,
                             const std::vector<VegaJson>& texts) {
    std::vector<double> numbers(keys.size());
    std::vector<std::string> words(texts.size());
    for (std::size_t i = 0; i < part.at(keys.front()).size(); ++i) {
        for (std::size_t k = 0; k < keys.size(); ++k) {
            const auto& cell = part.at(keys[k]).at(i);
            numbers[k] = cell.is_null() ? std::nan("") : cell.get<double>();
        }
        for (std::size_t t = 0; t < texts.size(); ++t)
            words[t] = (texts[t].is_array() ? texts[t].at(i) : texts[t]).get<std::string>();
        add(numbers, words);
    }
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

}  // namespace flightwatt::report
