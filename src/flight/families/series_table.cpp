#include "flight/families/series_table.h"

#include "base/csv.h"
#include "base/error.h"
#include "base/number.h"
#include "base/text.h"
#include "base/toml_reader.h"
#include "base/units.h"
#include "flight/families/log_family.h"
#include "flight/flight_data.h"
#include "flight/select.h"
#include "flight/telemetry_series.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::flight {
namespace {

/// Reads the table row by row.
class TableReader {
  public:
    TableReader(FrontMatter matter, std::string_view text, CsvDialect dialect, const std::string& file)
        : matter_(std::move(matter)), text_(text), dialect_(dialect), file_(file) {}

    void read_row(const CsvRowView& row) {
        if (columns_.empty()) return bind(row);
        if (std::ranges::equal(row.cells, columns_, {}, &CsvRowView::Cell::text))
            return;  // of a file that was appended
        const double time_s = number(row, time_column_);
        if (time_s < last_s_ && begins_recording(row.line)) {
            end_recording();
        } else if (!(time_s > last_s_)) {
            throw InputError({file_, row.line, row.cells[time_column_].column},
                             fmt::format("time_s = {} does not rise from {}", time_s, last_s_),
                             "sort the rows by time and remove repeated times");
        }
        last_s_ = time_s;
        for (std::size_t i = 0; i < columns_.size(); ++i) {
            if (i == time_column_ || row.cells[i].text.empty()) continue;
            auto& track = columns_[i] == matter_.chosen_column ? chosen_ : matter_.series.tracks[track_of_[i]];
            track.time_s.push_back(time_s);
            track.value.push_back(number(row, i));
        }
    }

    /// The series of each recording, with the tracks that have a column.
    std::vector<FlightSeries> take() {
        end_recording();
        for (auto& series : recordings_) {
            std::size_t track = 0;
            std::erase_if(series.tracks, [&](const Track&) { return !is_bound_[track++]; });
        }
        if (!matter_.present) {
            refuse_slow_clock();
            std::ranges::for_each(recordings_, [&](FlightSeries& series) { add_power(series); });
        }
        if (recordings_.size() == 1 && !chosen_.empty()) require_chosen(recordings_.front());
        return std::move(recordings_);
    }

  private:
    void refuse_slow_clock() const {
        for (const auto& series : recordings_) {
            if (series.tracks.empty()) continue;
            const auto& longest =
                std::ranges::max(series.tracks, {}, [](const Track& track) { return track.time_s.size(); });
            if (const auto finding = slow_clock_finding("time_s", longest.time_s); !finding.empty())
                throw InputError({file_}, finding,
                                 "write seconds, or name the column otherwise and state its unit in a column map");
        }
    }

    /// Without power_w it is voltage_v times current_a, where a row has both.
    void add_power(FlightSeries& series) const {
        const auto track_of = [&](std::string_view name) {
            const auto found = std::ranges::find(series.tracks, name, &Track::name);
            return found == series.tracks.end() ? nullptr : &*found;
        };
        const auto* voltage = track_of("voltage_v");
        const auto* current = track_of("current_a");
        if (track_of("power_w") != nullptr || voltage == nullptr || current == nullptr) return;
        Track power{.name = "power_w", .source = "voltage_v * current_a"};
        for (std::size_t i = 0, j = 0; i < voltage->time_s.size(); ++i) {
            while (j < current->time_s.size() && current->time_s[j] < voltage->time_s[i]) ++j;
            if (j == current->time_s.size()) break;
            if (current->time_s[j] != voltage->time_s[i]) continue;
            power.time_s.push_back(voltage->time_s[i]);
            power.value.push_back(voltage->value[i] * current->value[j]);
        }
        if (power.empty()) return;
        if (is_negative_throughout(power.value))
            throw InputError({file_}, "the power is negative throughout: a discharge has a negative current",
                             "turn the sign of current_a");
        series.tracks.push_back(std::move(power));
        sort_tracks(series.tracks);
    }

    void require_chosen(const FlightSeries& series) const {
        const auto power = select_tracks(series).power_w;
        if (power.time_s == chosen_.time_s && power.value == chosen_.value) return;
        throw InputError({file_},
                         fmt::format("{} is not the power that its candidates {}.2 ... give: was it changed?",
                                     matter_.chosen_column, matter_.chosen_column),
                         "remove the other columns of power, and the comment lines of the columns, to use your own");
    }

    /// Whether the file has another recording from this line on.
    bool begins_recording(std::size_t line) {
        if (starts_.empty()) starts_ = find_recordings();
        return std::ranges::binary_search(starts_, line);
    }

    /// The first lines of the recordings.
    std::vector<std::size_t> find_recordings() const {
        telemetry::MessageTable rows{"row", {}, {{"number", {}, {}}}, {}};  // rows of equal times differ
        for_each_csv_row(
            text_, file_,
            [&](const CsvRowView& row) {
                const double time_s = number_or_nan(row.cells[time_column_].text);
                if (std::isnan(time_s)) return;
                rows.time_s.push_back(time_s);
                rows.places.push_back(row.line);
                rows.columns[0].values.push_back(static_cast<double>(row.line));
            },
            dialect_);
        std::vector<std::size_t> starts;
        for (const auto& part : recordings_of({file_, "", {}, {{"", {std::move(rows)}}}, {}, {}, 0}))
            starts.push_back(part.senders.front().tables.front().places.front());
        return starts;
    }

    void end_recording() {
        std::vector<Track> next;
        for (const auto& track : matter_.series.tracks)
            next.push_back({track.name, track.source, track.device, track.since_s});
        auto tracks = std::exchange(matter_.series.tracks, std::move(next));
        recordings_.push_back(matter_.series);
        recordings_.back().tracks = std::move(tracks);
    }

    double number(const CsvRowView& row, std::size_t column) const {
        const auto& cell = row.cells[column];
        if (const double value = number_or_nan(cell.text); !std::isnan(value)) return value;
        throw InputError({file_, row.line, cell.column},
                         fmt::format("{} is not a finite number: '{}'", columns_[column], cell.text));
    }

    void bind(const CsvRowView& header) {
        CsvTable names{file_, {}, {}};
        for (const auto& cell : header.cells) names.columns.emplace_back(cell.text);
        columns_ = names.columns;
        time_column_ = column_index(names, "time_s");
        const bool has_altitude = std::ranges::find(columns_, "altitude_m") != columns_.end();
        if (!matter_.present && !has_altitude) column_index(names, "power_w");
        is_bound_.assign(matter_.columns.size(), false);
        for (std::size_t i = 0; i < columns_.size(); ++i) {
            const auto here = columns_.begin() + static_cast<std::ptrdiff_t>(i);
            if (std::find(columns_.begin(), here, *here) != here) {
                throw InputError({file_, header.line}, fmt::format("column '{}' appears twice", *here),
                                 "keep one of them");
            }
            const bool is_track = i != time_column_ && *here != matter_.chosen_column;
            track_of_.push_back(is_track ? find_track(header.line, *here) : 0);
        }
    }

    /// Index of the column's track; a track without metadata is added.
    std::size_t find_track(std::size_t line, const std::string& column) {
        const auto listed = std::find(matter_.columns.begin(), matter_.columns.end(), column);
        if (listed != matter_.columns.end()) {
            const auto index = static_cast<std::size_t>(listed - matter_.columns.begin());
            is_bound_[index] = true;
            return index;
        }
        std::vector<std::string> known{"time_s"};
        known.insert(known.end(), track_names().begin(), track_names().end());
        if (std::find(known.begin(), known.end(), column) == known.end())
            throw InputError({file_, line}, fmt::format("unknown column '{}'", column),
                             meant_or(column, known, fmt::format("a series has {}", fmt::join(known, ", "))));
        matter_.columns.push_back(column);
        matter_.series.tracks.push_back({.name = column, .source = plain_source});
        is_bound_.push_back(true);
        return matter_.columns.size() - 1;
    }

    FrontMatter matter_;
    Track chosen_;  ///< the values of the chosen column
    std::string_view text_;
    CsvDialect dialect_;
    std::string file_;
    std::vector<FlightSeries> recordings_;  ///< those that ended
    std::vector<std::size_t> starts_;       ///< lines of all, once a time falls
    std::vector<std::string> columns_;
    std::vector<std::size_t> track_of_;  ///< of each column
    std::vector<bool> is_bound_;         ///< of each track
    std::size_t time_column_ = 0;
    double last_s_ = -std::numeric_limits<double>::infinity();
};

}  // namespace

std::vector<FlightSeries> read_series_table(FrontMatter matter, std::string_view text, const std::string& file) {
    CsvDialect dialect;  // of what FlightWatt writes
    if (!matter.present) dialect = with_decimals(find_csv_header(text, file, {"time_s"}).dialect, text, file);
    TableReader reader(std::move(matter), text, dialect, file);
    for_each_csv_row(
        text, file, [&](const CsvRowView& row) { reader.read_row(row); }, dialect);
    return reader.take();
}

std::string slow_clock_finding(const std::string& column, const std::vector<double>& time_s) {
    constexpr double max_interval_s = 15.0;
    constexpr double max_days = 4.0;
    constexpr std::size_t enough_rows = 30;
    constexpr double day_s = 24.0 * units::seconds_per_hour;
    if (time_s.size() < enough_rows) return "";
    const double interval_s = median_interval_s(time_s);
    const double days = interval_s * static_cast<double>(time_s.size()) / day_s;
    if (interval_s <= max_interval_s && days <= max_days) return "";
    return fmt::format("the times of '{}' are {:.3g} s apart, for {:.3g} days: they are in a smaller unit", column,
                       interval_s, days);
}

bool is_negative_throughout(const std::vector<double>& power_w) {
    constexpr double min_ratio = 100.0;
    double drawn = 0.0;
    double returned = 0.0;
    for (const double value : power_w)
        if (std::isfinite(value)) (value < 0.0 ? returned : drawn) += std::abs(value);
    return returned > min_ratio * drawn;
}

}  // namespace flightwatt::flight
