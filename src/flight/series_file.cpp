#include "flight/series_file.h"

#include "base/atomic_file.h"
#include "base/csv.h"
#include "base/error.h"
#include "base/number.h"
#include "base/toml_reader.h"
#include "flight/selected_track.h"
#include "flight/series_file/front_matter.h"
#include "flight/series_file/series_table.h"
#include "telemetry/log_configuration.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::flight {
namespace {

/// Reads the table behind the front matter row by row.
class TableReader {
  public:
    TableReader(FrontMatter matter, std::string file) : matter_(std::move(matter)), file_(std::move(file)) {}

    void read_row(const CsvRowView& row) {
        if (columns_.empty()) return bind(row);
        const double time_s = number(row, time_column_);
        if (!(time_s > last_s_)) {
            throw InputError({file_, row.line, row.cells[time_column_].column},
                             fmt::format("time_s = {} does not rise from {}", time_s, last_s_),
                             "sort the rows by time and keep one of each");
        }
        last_s_ = time_s;
        for (std::size_t i = 0; i < columns_.size(); ++i) {
            if (i == time_column_ || row.cells[i].text.empty()) continue;
            auto& track = matter_.series.tracks[track_of_[i]];
            track.time_s.push_back(time_s);
            track.value.push_back(number(row, i));
        }
    }

    /// The series; the tracks are those that have a column.
    FlightSeries take() {
        auto series = std::move(matter_.series);
        std::vector<Track> tracks;
        for (std::size_t i = 0; i < series.tracks.size(); ++i) {
            if (is_bound_[i]) tracks.push_back(std::move(series.tracks[i]));
        }
        series.tracks = std::move(tracks);
        return series;
    }

  private:
    double number(const CsvRowView& row, std::size_t column) const {
        const auto& cell = row.cells[column];
        if (const double value = number_or_nan(cell.text); !std::isnan(value)) return value;
        throw InputError({file_, row.line, cell.column},
                         fmt::format("{} is not a finite number: '{}'", columns_[column], cell.text));
    }

    void bind(const CsvRowView& header) {
        CsvTable table{file_, {}, {}};
        for (const auto& cell : header.cells) table.columns.emplace_back(cell.text);
        columns_ = table.columns;
        time_column_ = column_index(table, "time_s");
        const bool has_altitude = std::ranges::find(columns_, "altitude_m") != columns_.end();
        if (!matter_.present && !has_altitude) column_index(table, "power_w");
        is_bound_.assign(matter_.columns.size(), false);
        for (std::size_t i = 0; i < columns_.size(); ++i) {
            const auto here = columns_.begin() + static_cast<std::ptrdiff_t>(i);
            if (std::find(columns_.begin(), here, *here) != here) {
                throw InputError({file_, header.line}, fmt::format("column '{}' stands there twice", *here),
                                 "keep one of them");
            }
            track_of_.push_back(i == time_column_ ? 0 : find_track(header.line, *here));
        }
    }

    /// The track that the column holds; one that no front matter knows is made.
    std::size_t find_track(std::size_t line, const std::string& column) {
        const auto listed = std::find(matter_.columns.begin(), matter_.columns.end(), column);
        if (listed != matter_.columns.end()) {
            const auto index = static_cast<std::size_t>(listed - matter_.columns.begin());
            is_bound_[index] = true;
            return index;
        }
        std::vector<std::string> known{"time_s"};
        known.insert(known.end(), track_names().begin(), track_names().end());
        if (std::find(known.begin(), known.end(), column) == known.end()) {
            const auto near = nearest_word(column, known);
            throw InputError({file_, line}, fmt::format("unknown column '{}'", column),
                             near.empty() ? fmt::format("a series has {}", fmt::join(known, ", "))
                                          : fmt::format("did you mean '{}'?", near));
        }
        matter_.columns.push_back(column);
        matter_.series.tracks.push_back({.name = column, .source = plain_source});
        is_bound_.push_back(true);
        return matter_.columns.size() - 1;
    }

    FrontMatter matter_;
    std::string file_;
    std::vector<std::string> columns_;
    std::vector<std::size_t> track_of_;  ///< of each column
    std::vector<bool> is_bound_;         ///< of each track
    std::size_t time_column_ = 0;
    double last_s_ = -std::numeric_limits<double>::infinity();
};

}  // namespace

std::string to_csv(const FlightSeries& series) {
    std::string text;
    write_csv(
        series, [&](std::string_view piece) { text += piece; }, 1);
    return text;
}

void write_csv(const FlightSeries& series, const TextSink& sink, std::size_t max_threads) {
    const auto names = column_names(series.tracks);
    sink(fmt::format("{}time_s,{}\n", format_front_matter(series), fmt::join(names, ",")));
    write_series_rows(series.tracks, sink, max_threads);
}

FlightSeries parse_series_csv(std::string_view text, const std::filesystem::path& file) {
    TableReader reader(read_front_matter(text, file.string()), file.string());
    for_each_csv_row(text, file.string(), [&](const CsvRowView& row) { reader.read_row(row); });
    auto series = reader.take();
    series.file = file.string();
    if (series.flight.empty()) series.flight = telemetry::flight_name(file);
    const auto samples = power_track(series).time_s.size();
    const bool is_flight = samples >= 2 || (samples == 0 && select_track(series, "altitude_m").time_s.size() >= 2);
    if (!is_flight) throw InputError({series.file}, "has fewer than two samples");
    return series;
}

FlightSeries read_series_csv(const std::filesystem::path& path) { return parse_series_csv(read_file(path), path); }

}  // namespace flightwatt::flight
