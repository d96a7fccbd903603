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

/// The vocabulary of all figures: their data, and the Vega-Lite specifications that they fill.
namespace flightwatt::report {

using VegaJson = nlohmann::ordered_json;

/// A figure: a Vega-Lite specification with its data, and what stands around it. The same specification is
/// drawn by the page and rendered to a file.
struct Figure {               // NOLINT(bugprone-exception-escape): of nlohmann's moves
    std::string id;           ///< of letters, digits and '-': a file's name
    std::string caption;      ///< under the figure, for readers
    std::string description;  ///< instead of the figure, for those who do not see it: what its data say
    VegaJson spec;
};

/// The files of web/figures and the pages of web, built into the program, by their names without endings.
const std::map<std::string_view, std::string_view>& web_templates();

/// The specification web/figures/NAME.vl.json. Texts "{{FIELD}}" in it stand for what depends on data. A panel's name is
/// a layer: a title would stand above the highest label of its own axis, and so on another line than its neighbour's.
/// Zoom is by Ctrl and wheel, for the wheel alone scrolls the page.
VegaJson figure_template(std::string_view name);

/// `part` of a template with each "{{FIELD}}" replaced by that member of `values`, where they have it. Layers whose data
/// become null are left out.
VegaJson filled(VegaJson part, const VegaJson& values);

/// The figure `id` of the template `name`, filled; the panel of "concat" once with each of the values in "panels".
Figure new_figure(std::string_view name, std::string id, std::string caption, std::string description,
                  const VegaJson& values = {});

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
    /// For a specification's "datasets".
    const std::string& csv() const { return csv_; }

  private:
    std::vector<std::string> numbers_;
    std::vector<int> decimals_;  ///< of the columns of numbers; empty: six digits each
    std::string csv_;
    std::size_t rows_ = 0;
};

/// The decimals that tell the extent of `values` apart in so many steps, at least `least`.
int decimals_for(std::span<const double> values, double steps, int least);

/// The rows of a line that a screen of so many pixel columns can tell from all rows: of each column the
/// first, the last, the least and the greatest value (M4: Jugel et al., VLDB 2014). Indices, rising. All of
/// them where there are no more than four a column.
std::vector<std::size_t> downsample_m4(const std::vector<double>& time_s, const std::vector<double>& values,
                                       std::size_t columns);

/// "take-off", "cruise", "landing": as people write them.
constexpr std::string_view phase_word(flight::Phase phase) {
    return phase == flight::Phase::takeoff ? std::string_view("take-off") : to_string(phase);
}

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
