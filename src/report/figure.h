#pragma once

#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

namespace flightwatt::report {

using VegaJson = nlohmann::ordered_json;

/// A figure: a Vega-Lite specification with its data, and what stands around it. The same specification is
/// drawn by the page and rendered to a file.
struct Figure {               // NOLINT(bugprone-exception-escape): of nlohmann's moves
    std::string id;           ///< of letters, digits and '-': a file's name
    std::string caption;      ///< under the figure, for readers
    std::string description;  ///< instead of the figure, for those who do not see it: what its data say
    std::string time_signal;  ///< of the zoomed time axis, for the keyboard; empty without one
    std::string time_scale;
    VegaJson spec;
};

/// A table of a figure as Vega-Lite's inline CSV, a third of the size of JSON's rows. Columns of numbers come
/// first. What is not finite becomes an empty cell (a gap in a line). Six digits are more than a screen
/// shows.
class FigureData {
  public:
    FigureData(std::initializer_list<std::string> numbers, std::initializer_list<std::string> texts = {});
    void add(std::initializer_list<double> numbers, std::initializer_list<std::string_view> texts = {});
    bool empty() const { return rows_ == 0; }
    /// For a specification's "data".
    VegaJson json() const;
    /// For a specification's "datasets", and the reference to it by its name.
    const std::string& csv() const { return csv_; }
    VegaJson reference(std::string_view name) const;

  private:
    std::vector<std::string> numbers_;
    std::string csv_;
    std::size_t rows_ = 0;
    VegaJson format() const;
};

/// The start of a specification: schema and description.
VegaJson new_spec(const Figure& figure);

/// A channel of numbers: {"field", "type", "title"} and whatever `more` adds.
VegaJson quantity(std::string_view field, std::string_view title, const VegaJson& more = VegaJson::object());
/// A channel of names.
VegaJson category(std::string_view field, std::string_view title, const VegaJson& more = VegaJson::object());

/// The parameter that zooms and pans a panel's axis `channel` ("x") by dragging and Ctrl + wheel.
VegaJson zoom_parameter(std::string_view channel);

/// The parameter by which a click on the legend hides a series and shows it again: `series` are all values of
/// `field`, and `view` is the panel that draws them. shown_by_legend() is the channel "opacity" to go with
/// it.
VegaJson legend_parameter(std::string_view field, const VegaJson& series, std::string_view view);
VegaJson shown_by_legend();

/// Replaces what is not UTF-8 (names of files) by U+FFFD.
std::string valid_utf8(std::string_view text);

/// As JSON that may stand in an HTML script element, whatever its texts hold.
std::string script_json(const VegaJson& json);

}  // namespace flightwatt::report
