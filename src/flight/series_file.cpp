#include "flight/series_file.h"

#include "base/atomic_file.h"
#include "base/csv.h"
#include "base/error.h"
#include "base/number.h"
#include "base/parallel.h"
#include "base/toml_reader.h"
#include "flight/selected_track.h"
#include "flight/series_file/front_matter.h"
#include "telemetry/log_configuration.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::flight {
namespace {

/// What is left of a track within a part of the table.
struct Cursor {
    const double* time_s;
    const double* end_s;
    const double* value;

    double next_s() const { return time_s == end_s ? std::numeric_limits<double>::infinity() : *time_s; }
};

/// The rows of a part of the table: one for each time at which any track has a value, with a cell for each track.
std::string rows_between(const std::vector<Track>& tracks, double from_s, double until_s) {
    std::vector<Cursor> cursors;
    cursors.reserve(tracks.size());
    for (const auto& track : tracks) {
        const auto first = std::ranges::lower_bound(track.time_s, from_s) - track.time_s.begin();
        const auto last = std::ranges::lower_bound(track.time_s, until_s) - track.time_s.begin();
        cursors.push_back({track.time_s.data() + first, track.time_s.data() + last, track.value.data() + first});
    }
    std::vector<char> row((tracks.size() + 1) * (number_buffer_size + 1));
    std::string text;
    while (true) {
        double time_s = std::numeric_limits<double>::infinity();
        for (const auto& cursor : cursors) time_s = std::min(time_s, cursor.next_s());
        if (!std::isfinite(time_s)) return text;
        char* to = write_number(row.data(), time_s);
        for (auto& cursor : cursors) {
            *to++ = ',';
            if (cursor.next_s() != time_s) continue;
            to = write_number(to, *cursor.value);
            ++cursor.time_s;
            ++cursor.value;
        }
        *to++ = '\n';
        text.append(row.data(), to);
    }
}

/// The rows in parts, made on `max_threads` at most (0: on every core), in order.
void write_rows(const std::vector<Track>& tracks, const TextSink& sink, std::size_t max_threads) {
    constexpr std::size_t samples_at_once = 1024;
    constexpr double infinite_s = std::numeric_limits<double>::infinity();
    std::vector<double> borders_s{-infinite_s};
    const auto densest = std::ranges::max_element(tracks, {}, [](const Track& track) { return track.time_s.size(); });
    if (densest != tracks.end()) {
        for (auto i = samples_at_once; i < densest->time_s.size(); i += samples_at_once)
            borders_s.push_back(densest->time_s[i]);
    }
    borders_s.push_back(infinite_s);
    const auto parts = borders_s.size() - 1;
    std::vector<std::string> texts(threads_for(parts, max_threads));
    for_each_in_order(
        parts,
        [&](std::size_t i, std::size_t place) { texts[place] = rows_between(tracks, borders_s[i], borders_s[i + 1]); },
        [&](std::size_t, std::size_t place) { sink(texts[place]); }, max_threads);
}

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
    write_rows(series.tracks, sink, max_threads);
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
