#pragma once

#include "flight/flight_phases.h"

#include <cstddef>
#include <initializer_list>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

/// Data of figures, and Vega-Lite specifications with them.
namespace flightwatt::report {

using VegaJson = nlohmann::ordered_json;

/// A Vega-Lite specification with its data and texts; the page draws it, and --figures writes it to a file.
struct Figure {               // NOLINT(bugprone-exception-escape): of nlohmann's moves
    std::string id;           ///< of letters, digits and '-': a file's name
    std::string caption;      ///< below the figure
    std::string description;  ///< its data in words, for screen readers
    VegaJson spec;
};

/// The files of web/figures and the pages of web, built into the program, by their names without endings.
const std::map<std::string_view, std::string_view>& web_templates();

/// The specification web/figures/NAME.vl.json; texts "{{FIELD}}" in it are placeholders.
VegaJson figure_template(std::string_view name);

/// `part` of a template with each "{{FIELD}}" replaced by that member of `values`, if there is one. Layers with null
/// data are removed.
VegaJson fill_template(VegaJson part, const VegaJson& values);

/// A figure of the template `name`; with "panels" in `values`, its panel of "concat" is repeated with each of them.
Figure new_figure(std::string_view name, std::string id, std::string caption, std::string description,
                  const VegaJson& values = {});

/// Data of a figure as Vega-Lite's inline CSV: columns of numbers, with six digits, and then of texts. Infinity and NaN
/// are empty cells (gaps in a line).
class FigureData {
  public:
    FigureData(std::initializer_list<std::string> numbers, std::initializer_list<std::string> texts = {});
    /// Decimals of the columns of numbers instead of six digits; to be called before any row.
    void round_to(std::vector<int> decimals) { decimals_ = std::move(decimals); }
    void add(std::initializer_list<double> numbers, std::initializer_list<std::string_view> texts = {});
    bool empty() const { return rows_ == 0; }
    /// For a specification's "data".
    VegaJson json() const;
    /// For a specification's "datasets".
    const std::string& csv() const { return csv_; }

  private:
    std::vector<std::string> numbers_;
    std::vector<int> decimals_;  ///< of the columns of numbers; empty: six digits each
    std::string csv_;
    std::size_t rows_ = 0;
};

/// Indices, rising, of the rows that draw the same line on `columns` pixel columns: the first, last, smallest and
/// largest value of each (M4: Jugel et al., VLDB 2014). All rows where there are no more than four a column.
std::vector<std::size_t> downsample_m4(const std::vector<double>& time_s, const std::vector<double>& values,
                                       std::size_t columns);

/// `count` of the values at equal steps, with the first and the last; all of them where there are no more.
template <typename Value>
std::vector<Value> evenly_chosen(const std::vector<Value>& values, std::size_t count) {
    if (values.size() <= count) return values;
    std::vector<Value> chosen;
    for (std::size_t i = 0; i < count; ++i)
        chosen.push_back(values[count == 1 ? 0 : i * (values.size() - 1) / (count - 1)]);
    return chosen;
}

/// "take-off", "cruise", "landing".
constexpr std::string_view phase_word(flight::Phase phase) {
    return phase == flight::Phase::takeoff ? std::string_view("take-off") : to_string(phase);
}

/// JSON without '<', for an HTML script element.
std::string script_json(const VegaJson& json);

}  // namespace flightwatt::report
