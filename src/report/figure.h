#pragma once

#include "flight/flight_phases.h"

#include <cstddef>
#include <initializer_list>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

/// Figures as Vega-Lite specifications with their data.
namespace flightwatt::report {

using VegaJson = nlohmann::ordered_json;

/// A Vega-Lite specification with its data and texts, for a file.
struct Figure {               // NOLINT(bugprone-exception-escape): of nlohmann's moves
    std::string id;           ///< name of its file: letters, digits and '-'
    std::string description;  ///< its data in words
    VegaJson spec;
    std::string section = {};  ///< what it is about: "Flights"
};

/// Returns the files of web/figures and the pages of web, built into the program, by their names without endings.
const std::map<std::string_view, std::string_view>& web_templates();

/// Returns the specification web/figures/NAME.vl.json, in which texts "{{FIELD}}" are placeholders.
VegaJson figure_template(std::string_view name);

/// Returns `part` of a template with each "{{FIELD}}" replaced by that member of `values`, if there is one, and without
/// layers whose data are null.
VegaJson fill_template(VegaJson part, const VegaJson& values);

/// Returns a figure of the template `name`, filled with `values`. If these have "panels", the template's panel in
/// "concat" is repeated with each of them.
Figure new_figure(std::string_view name, std::string id, std::string description, const VegaJson& values = {});

/// The data of a figure as Vega-Lite's inline CSV: columns of numbers, with seven digits, then columns of texts. Infinity
/// and NaN are empty cells (gaps in a line).
class FigureData {
  public:
    /// Begins a table with the names of its columns.
    FigureData(std::initializer_list<std::string> numbers, std::initializer_list<std::string> texts = {});
    /// Adds a row.
    void add(const std::vector<double>& numbers, const std::vector<std::string>& texts = {});
    /// Adds a row for each element of the columns `keys` of `part`, null being NaN. A text is that of every row, or an
    /// array with one for each.
    void add_columns(const VegaJson& part, const std::vector<std::string>& keys,
                     const std::vector<VegaJson>& texts = {});
    bool empty() const { return rows_ == 0; }
    /// Returns the table for a specification's "data".
    VegaJson json() const;
    /// Returns the table for a specification's "datasets".
    const std::string& csv() const { return csv_; }

  private:
    std::vector<std::string> numbers_;
    std::string csv_;
    std::size_t rows_ = 0;
};

/// Returns the indices, rising, of rows that draw the same line on `columns` pixel columns as all: the first, last,
/// smallest and largest value of each column (M4: Jugel et al., VLDB 2014). All rows if there are at most four a
/// column.
std::vector<std::size_t> downsample_m4(const std::vector<double>& time_s, const std::vector<double>& values,
                                       std::size_t columns);

/// Returns `count` of the values at equal steps, with the first and the last; all if there are no more.
template <typename Value>
std::vector<Value> evenly_chosen(const std::vector<Value>& values, std::size_t count) {
    if (values.size() <= count) return values;
    std::vector<Value> chosen;
    for (std::size_t i = 0; i < count; ++i)
        chosen.push_back(values[count == 1 ? 0 : i * (values.size() - 1) / (count - 1)]);
    return chosen;
}

}  // namespace flightwatt::report
