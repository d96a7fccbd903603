#pragma once

#include "flight/flight_phases.h"

#include <cstddef>
#include <filesystem>
#include <initializer_list>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

/// The vocabulary of all figures: their data, and the parts that their Vega-Lite specifications share.
namespace flightwatt::report {

using VegaJson = nlohmann::ordered_json;

/// A figure: a Vega-Lite specification with its data, and what stands around it. The same specification is
/// drawn by the page and rendered to a file.
struct Figure {               // NOLINT(bugprone-exception-escape): of nlohmann's moves
    std::string id;           ///< of letters, digits and '-': a file's name
    std::string caption;      ///< under the figure, for readers
    std::string description;  ///< instead of the figure, for those who do not see it: what its data say
    VegaJson spec;
    std::string time_signal = {};  ///< of the zoomed time axis, for the keyboard; empty without one
    std::string time_scale = {};
};

/// The figure with the start of its specification: schema and description.
Figure new_figure(std::string id, std::string caption, std::string description);

/// A table of a figure as Vega-Lite's inline CSV, a third of the size of JSON's rows. Columns of numbers come first.
/// What is not finite becomes an empty cell (a gap in a line). Six digits are more than a screen shows.
class FigureData {
  public:
    FigureData(std::initializer_list<std::string> numbers, std::initializer_list<std::string> texts = {});
    /// Columns of numbers with so many decimals, instead of six digits: many flights are many digits. Before any row.
    void round_to(std::vector<int> decimals) { decimals_ = std::move(decimals); }
    void add(std::initializer_list<double> numbers, std::initializer_list<std::string_view> texts = {});
    bool empty() const { return rows_ == 0; }
    /// For a specification's "data".
    VegaJson json() const;
    /// For a specification's "datasets", and the reference to it by its name.
    const std::string& csv() const { return csv_; }
    VegaJson reference(std::string_view name) const;

  private:
    std::vector<std::string> numbers_;
    std::vector<int> decimals_;  ///< of the columns of numbers; empty: six digits each
    std::string csv_;
    std::size_t rows_ = 0;
    VegaJson format() const;
};

/// The decimals that tell the extent of `values` apart in so many steps, at least `least`.
int decimals_for(std::span<const double> values, double steps, int least);

/// The rows of a line that a screen of so many pixel columns can tell from all rows: of each column the
/// first, the last, the least and the greatest value (M4: Jugel et al., VLDB 2014). Indices, rising. All of
/// them where there are no more than four a column.
std::vector<std::size_t> downsample_m4(const std::vector<double>& time_s, const std::vector<double>& values,
                                       std::size_t columns);

/// JSON as the documents of Vega-Lite write it.
VegaJson vega(std::string_view text);

/// A layer of a figure; `mark` is JSON text. Without data, it draws those of the layers that it is one of.
VegaJson layer(const VegaJson& data, std::string_view mark, const VegaJson& encoding);
VegaJson layer(std::string_view mark, const VegaJson& encoding);

/// A channel of numbers: {"field", "type", "title"} and whatever `more` adds.
VegaJson numeric_channel(std::string_view field, std::string_view title, const VegaJson& more = VegaJson::object());
/// A channel of names.
VegaJson nominal_channel(std::string_view field, std::string_view title, const VegaJson& more = VegaJson::object());
/// A number in a tooltip, in the format of d3: ".2f".
VegaJson tooltip_number(std::string_view field, std::string_view title, std::string_view format);

/// The channels "color" and "strokeWidth" [px] of the lines "measured" and "model" in the column "curve".
void add_measured_and_model(VegaJson& encoding, double measured_px, double model_px);

/// The colour of bars by power, with its legend below.
VegaJson power_ramp(std::string_view field, std::string_view title);

/// Panels beside and below each other, on one line whatever their labels.
void set_panels(Figure& figure, int columns, int row_gap_px, const VegaJson& panels);

/// The layer of a panel's name above it: a title would stand above the highest label of its own axis, and so on another
/// line than its neighbour's.
VegaJson panel_name(std::string_view name);

/// The parameter that zooms and pans the time axis "x" of `views` by dragging and Ctrl + wheel, and the figure's own
/// notes of it for the keyboard.
VegaJson add_zoom(Figure& figure, const VegaJson& views);

/// The parameter by which a click on the legend hides a series and shows it again: `series` are all values of
/// `field`, and `view` is the panel that draws them. shown_by_legend() is the channel "opacity" to go with
/// it.
VegaJson legend_parameter(std::string_view field, const VegaJson& series, std::string_view view);
VegaJson shown_by_legend();

/// "take-off", "cruise", "landing": as people write them.
constexpr std::string_view phase_word(flight::Phase phase) {
    return phase == flight::Phase::takeoff ? std::string_view("take-off") : to_string(phase);
}

/// The layer of phases' names (column "word") above a panel, at "middle_s".
VegaJson phase_names(const VegaJson& data, std::string_view time_title);

/// As JSON that may stand in an HTML script element, whatever its texts hold.
std::string script_json(const VegaJson& json);

/// A curve that was read off a published figure.
struct PublishedCurve {
    std::vector<double> time_s;
    std::vector<double> value;  ///< power_w or soc_percent
};

/// A cell of the published map of the state of charge over two qualities of service.
struct PublishedCell {
    double fps_low = 0.0;
    double fps_high = 0.0;
    double key_bits_low = 0.0;
    double key_bits_high = 0.0;
    double soc_percent = 0.0;
};

/// The digitised Figs. 2 (c-e), 3 (a, b) and 4 of the IRC 2020 paper.
struct PublishedFigures {
    flight::PerPhase<PublishedCurve> power;     ///< Fig. 2
    std::map<std::string, PublishedCurve> soc;  ///< Fig. 3, by the name of the mission in missions/paper
    std::vector<PublishedCell> soc_cells;       ///< Fig. 4
};

/// Reads fig2_PHASE.csv (time_s, power_w), fig3_MISSION.csv (time_s, soc_percent; '_' for '-') and
/// fig4_soc_cells.csv from a folder. Throws InputError for one that is missing or is no such table.
PublishedFigures read_published_figures(const std::filesystem::path& folder);

}  // namespace flightwatt::report
