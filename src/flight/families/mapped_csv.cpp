#include "flight/families/mapped_csv.h"

#include "base/clock_time.h"
#include "base/csv.h"
#include "base/error.h"
#include "base/number.h"
#include "base/units.h"
#include "flight/families/clock_steps.h"
#include "flight/families/log_family.h"
#include "flight/families/logging_pauses.h"
#include "flight/families/series_table.h"
#include "flight/telemetry_series.h"
#include "telemetry/log_configuration.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::flight {
namespace {

using Combine = MappedTrack::Combine;

/// Counters, angles and states are not averaged.
Merge merge_of(std::string_view track) {
    constexpr std::string_view averaged[] = {"_v", "_a", "_w", "_m", "_m_per_s", "_percent", "_c", "_rpm"};
    const bool is_mean = std::ranges::any_of(averaged, [&](auto suffix) { return track.ends_with(suffix); });
    return is_mean ? Merge::mean : Merge::latest;
}

/// Where a map's column is in a file, and what converts its numbers.
struct BoundColumn {
    std::size_t place = 0;
    double factor = 1.0;
    std::string name = {};
};

/// A track with the columns of a file.
struct BoundTrack {
    const MappedTrack* mapped;
    std::vector<BoundColumn> columns = {};
    std::vector<double> values = {};
};

/// The unit that a column has by its name, in brackets or behind its last "_": "mA" of "I (mA)" and "i_ma"; empty
/// without one.
std::string unit_in_name(const std::string& name) {
    const auto begin = name.find_last_of("([_");
    if (begin == std::string::npos) return "";
    const bool is_bracket = name[begin] != '_';
    const auto end = is_bracket ? name.find_first_of(")]", begin) : name.size();
    auto text = name.substr(begin + 1, end - begin - 1);
    const bool is_number = !is_bracket && !text.empty() && text.front() >= '0' && text.front() <= '9';  // "wind_10m"
    if (units::parse_unit(text)) return is_number ? "" : text;
    constexpr std::pair<std::string_view, const char*> lower_case[] = {{"mv", "mV"}, {"ma", "mA"},   {"mw", "mW"},
                                                                       {"kw", "kW"}, {"mah", "mAh"}, {"mwh", "mWh"}};
    const auto* const found = std::ranges::find(lower_case, text, &std::pair<std::string_view, const char*>::first);
    return found == std::end(lower_case) ? "" : found->second;
}

/// Finds the columns of a map in the header of a file. What a map of FlightWatt lacks is std::nullopt.
class ColumnBinder {
  public:
    ColumnBinder(const ColumnMap& map, CsvTable header, std::size_t line)
        : map_(map), header_(std::move(header)), where_{header_.file, line} {}

    /// The column of that name, with a unit of the quantity (any without one), or with none, which is then `tick`.
    std::optional<BoundColumn> find(const std::string& name, std::optional<units::Quantity> quantity,
                                    double tick) const {
        auto found = find_columns(header_.columns, name);
        std::erase_if(found, [&](const CsvColumn& column) {
            const auto unit = units::parse_unit(column.unit);
            return !column.unit.empty() && (!unit || unit->quantity != quantity.value_or(unit->quantity));
        });
        if (found.size() > 1)
            throw InputError(where_, fmt::format("has several columns '{}'", name),
                             found.front().unit.empty()
                                 ? "keep one of them"
                                 : fmt::format("name one with its unit: '{}'", header_.columns[found.front().index]));
        if (found.empty() && map_.is_shipped) return std::nullopt;
        if (found.empty())
            throw InputError(where_, fmt::format("has no column '{}'", name),
                             "its columns are " + short_list(header_.columns));
        const auto& [place, unit] = found.front();
        return BoundColumn{place, unit.empty() ? tick : units::parse_unit(unit)->factor, header_.columns[place]};
    }

    std::optional<BoundTrack> bind(const MappedTrack& track) const {
        const auto is_there = [&](const auto& name) { return !find_columns(header_.columns, name).empty(); };
        auto names = track.columns;
        if (track.combine == Combine::first && !names.empty()) {
            const auto first = std::ranges::find_if(names, is_there);
            names = {first == names.end() ? names.front() : *first};
        }
        const bool is_product = track.combine == Combine::product;
        BoundTrack bound{&track};
        for (const auto& name : names) {
            const double tick = is_product && !bound.columns.empty() ? 1.0 : track.unit_factor;
            const auto column = find(name, is_product ? std::nullopt : quantity_of(track.name), tick);
            if (!column) return std::nullopt;
            if (!track.states_unit && !map_.is_shipped) require_own_unit(track, *column);
            bound.columns.push_back(*column);
        }
        return bound;
    }

  private:
    /// Refuses a column whose name has another unit of the track's quantity than the one it is read in.
    void require_own_unit(const MappedTrack& track, const BoundColumn& column) const {
        const auto text = unit_in_name(column.name);
        const auto unit = units::parse_unit(text);
        const bool is_product = track.combine == Combine::product;
        const bool is_electrical =
            unit && (unit->quantity == units::Quantity::volt || unit->quantity == units::Quantity::ampere);
        if (!unit || unit->factor == column.factor ||
            !(is_product ? is_electrical : unit->quantity == quantity_of(track.name)))
            return;
        throw InputError(where_,
                         fmt::format("the column '{}' is in {} by its name, but its [[track]] {} states no unit",
                                     column.name, text, track.name),
                         is_product
                             ? fmt::format("add the factor to the unit of {}", track.name)
                             : fmt::format("add unit = \"{}\", or factor = 1 if its values are in the unit of {}", text,
                                           track.name));
    }

    const ColumnMap& map_;
    CsvTable header_;
    Location where_;
};

/// The part of a cell "latitude longitude" that a track has; other cells as they are.
std::string_view own_part(std::string_view cell, std::string_view track) {
    const auto blank = cell.find(' ');
    if (blank == std::string_view::npos || blank == 0 || !(track == "latitude_deg" || track == "longitude_deg"))
        return cell;
    if (track == "longitude_deg") return cell.substr(cell.find_last_of(' ') + 1);
    return cell.substr(0, cell[blank - 1] == ',' ? blank - 1 : blank);
}

/// Moves second 0 of a recording to its first row. `start_clock_s` is the Unix time of second 0.
void begin_at_zero(std::vector<double>& time_s, std::vector<telemetry::SkippedLines>& skipped, double& start_clock_s) {
    const double shift_s = time_s.front();
    start_clock_s += shift_s;
    for (double& t : time_s) t -= shift_s;
    for (auto& lines : skipped)
        for (auto& at : lines.lines) at.time_s -= shift_s;
}

/// Collects the raw rows of the tracks.
class MappedRows {
  public:
    MappedRows(const ColumnMap& map, std::string file) : map_(map), file_(std::move(file)) {}

    void read_row(const CsvRowView& row) {
        if (tracks_.empty()) return bind(row);
        const auto& cell = row.cells[time_place_].text;
        if (cell == time_name_) return;  // the header of a file that was appended
        const auto time_s = clock_.read(cell, date_place_ ? row.cells[*date_place_].text : "");
        if (!time_s && first_bad_time_.empty()) first_bad_time_ = cell;
        if (!time_s && !cell.empty()) count(words_, row);
        if (!time_s) return;
        rows_.time_s.push_back(*time_s);
        rows_.places.push_back(row.line);
        for (auto& [mapped, columns, values] : tracks_) {
            double value = mapped->combine == Combine::norm ? 0.0 : 1.0;
            for (const auto& [place, factor, name] : columns) {
                const double scaled = factor * number(row, place, mapped->name);
                value = mapped->combine == Combine::norm ? std::hypot(value, scaled) : value * scaled;
            }
            values.push_back(value * mapped->factor);
        }
    }

    void skip_row(const CsvRowView& row) { count(ragged_, row); }
    bool are_most_ragged() const { return ragged_.count() > rows_.time_s.size(); }

    /// A series for each recording.
    std::vector<FlightSeries> take() {
        if (rows_.time_s.size() < 2) refuse_times();
        refuse_slow_clock();
        add_power();
        for (auto& [mapped, columns, values] : tracks_) {
            if (mapped->name == "power_w") require_positive(values, source_of(*mapped, columns));
            rows_.columns.push_back({mapped->name, std::nullopt, std::move(values)});
        }
        auto steps = undo_clock_steps(rows_.time_s, rows_.places);
        telemetry::TelemetryLog log{file_, "", {}, {{"", {std::move(rows_)}}}, {}, {}, 0};
        for (auto* skipped : {&words_, &ragged_})
            if (!skipped->lines.empty()) log.skipped.push_back(std::move(*skipped));
        if (steps) log.skipped.push_back(*std::move(steps));
        std::vector<FlightSeries> recordings;
        for (auto& recording : recordings_of(std::move(log)))
            std::ranges::move(split_at_pauses(series_of(std::move(recording))), std::back_inserter(recordings));
        return recordings;
    }

  private:
    FlightSeries series_of(telemetry::TelemetryLog log) const {
        FlightSeries series;
        series.clock_restart = find_clock_restart(log.senders.front());
        auto& [message, time_s, columns, places] = log.senders.front().tables.front();
        series.start_clock_s = clock_.start_clock_s();
        // The clock of a recording that was appended, but made earlier, has another second 0.
        if (series.start_clock_s && time_s.front() < 0.0) begin_at_zero(time_s, log.skipped, *series.start_clock_s);
        for (std::size_t t = 0; t < tracks_.size(); ++t) {
            const auto& mapped = *tracks_[t].mapped;
            auto track = make_track(time_s, columns[t].values, merge_of(mapped.name));
            track.name = mapped.name;
            track.source = source_of(mapped, tracks_[t].columns);
            series.tracks.push_back(std::move(track));
        }
        sort_tracks(series.tracks);
        series.notes = notes_;
        series.skipped = std::move(log.skipped);
        for (auto& skipped : series.skipped)
            std::ranges::stable_sort(skipped.lines, {}, &telemetry::SkippedLines::AtTime::time_s);
        return series;
    }

    void bind(const CsvRowView& header) {
        std::vector<std::string> columns;
        for (const auto& cell : header.cells) columns.emplace_back(cell.text);
        const ColumnBinder binder(map_, {file_, columns, {}}, header.line);
        const auto time = binder.find(map_.time_column, units::Quantity::second, map_.tick_s);
        if (!time) throw InputError({file_, header.line}, fmt::format("has no time in '{}'", map_.time_column));
        time_place_ = time->place;
        time_name_ = columns[time_place_];
        clock_ = TimeColumn(time->factor, map_.is_unix_time);
        if (const auto date = find_columns(columns, map_.date_column); !date.empty()) date_place_ = date.front().index;
        for (const auto& track : map_.tracks)
            if (auto bound = binder.bind(track)) tracks_.push_back(std::move(*bound));
        if (map_.is_shipped && find_track("current_a")) note_other_currents(columns);
        const bool has_power = find_track("power_w") || (find_track("voltage_v") && find_track("current_a"));
        if (!has_power && !find_track("altitude_m"))
            throw InputError({file_, header.line}, "has no columns of power or altitude");
    }

    /// Further columns in A or mA may be of a second pack, or of a part of the first.
    void note_other_currents(const std::vector<std::string>& columns) {
        std::vector<std::string> others;
        for (std::size_t place = 0; place < columns.size(); ++place) {
            const auto unit = units::parse_unit(unit_in_name(columns[place]));
            const bool is_read = std::ranges::any_of(tracks_, [&](const BoundTrack& track) {
                return std::ranges::find(track.columns, place, &BoundColumn::place) != track.columns.end();
            });
            if (unit && unit->quantity == units::Quantity::ampere && !is_read) others.push_back(columns[place]);
        }
        if (!others.empty())
            notes_.push_back(
                fmt::format("the power is that of one current; not read: {} (a second pack's would be missing)",
                            fmt::join(others, ", ")));
    }

    BoundTrack* find_track(std::string_view name) {
        const auto found = std::ranges::find(tracks_, name, [](const auto& track) { return track.mapped->name; });
        return found == tracks_.end() ? nullptr : &*found;
    }

    /// NaN for an empty cell and one that is no number; the latter is counted.
    double number(const CsvRowView& row, std::size_t place, std::string_view track) {
        const auto text = own_part(row.cells[place].text, track);
        const double value = number_or_nan(text);
        if (std::isnan(value) && !text.empty()) count(words_, row);
        return value;
    }

    void count(telemetry::SkippedLines& skipped, const CsvRowView& row) const {
        const double time_s = rows_.time_s.empty() ? 0.0 : rows_.time_s.back();
        auto& lines = skipped.lines;
        if (!lines.empty() && lines.back().time_s == time_s)
            ++lines.back().count;
        else
            lines.push_back({time_s, 1, row.line});
    }

    /// Without a track power_w it is the product of voltage and current.
    void add_power() {
        static const MappedTrack power{"power_w", Combine::product, {}};
        const auto* voltage = find_track("voltage_v");
        const auto* current = find_track("current_a");
        if (find_track("power_w") != nullptr || voltage == nullptr || current == nullptr) return;
        BoundTrack product{&power, voltage->columns, voltage->values};
        product.columns.insert(product.columns.end(), current->columns.begin(), current->columns.end());
        std::ranges::transform(product.values, current->values, product.values.begin(), std::multiplies());
        tracks_.push_back(std::move(product));
    }

    static std::string source_of(const MappedTrack& mapped, const std::vector<BoundColumn>& columns) {
        std::vector<std::string> names;
        names.reserve(columns.size());
        for (const auto& column : columns) names.push_back(column.name);
        if (names.empty()) return "column map";
        return mapped.combine == Combine::norm ? fmt::format("|{}|", fmt::join(names, ", "))
                                               : fmt::format("{}", fmt::join(names, " * "));
    }

    /// Many loggers count the current of a discharge as negative.
    void require_positive(const std::vector<double>& power_w, const std::string& source) const {
        if (!is_negative_throughout(power_w)) return;
        throw InputError({file_}, "the power is negative throughout: a discharge has a negative current",
                         fmt::format("turn its sign with factor = -1 in the [[track]] of {}",
                                     source.find(" * ") == std::string::npos ? "power_w" : "power_w or current_a"));
    }

    [[noreturn]] void refuse_times() const {
        throw InputError({file_}, "has fewer than two rows with a time",
                         first_bad_time_.empty() ? ""
                                                 : fmt::format("'{}' is no time: expected numbers, HH:MM:SS.mmm or "
                                                               "YYYY-MM-DD HH:MM:SS.mmm, all in one way",
                                                               first_bad_time_));
    }

    /// Numbers with which a flight lasts for days are in another unit.
    void refuse_slow_clock() const {
        const auto finding = clock_.is_clock() ? "" : slow_clock_finding(time_name_, rows_.time_s);
        if (!finding.empty())
            throw InputError({file_}, finding,
                             "state it in the column map, in [time]: unit = \"ms\", \"us\" or \"ns\"");
    }

    const ColumnMap& map_;
    std::string file_;
    std::size_t time_place_ = 0;
    std::optional<std::size_t> date_place_;
    TimeColumn clock_;
    std::vector<BoundTrack> tracks_;
    std::string time_name_;
    telemetry::MessageTable rows_{"row", {}, {}, {}};
    std::string first_bad_time_;
    std::vector<std::string> notes_;
    telemetry::SkippedLines words_{"cells that are no numbers", {}, telemetry::SkippedLines::Unit::line};
    telemetry::SkippedLines ragged_{"another number of cells than the header", {}, telemetry::SkippedLines::Unit::line};
};

}  // namespace

std::vector<FlightSeries> parse_mapped_csv(std::string_view csv, const std::filesystem::path& file,
                                           const ColumnMap& map) {
    const auto header = find_csv_header(csv, file.string(), header_names(map), map.skip_lines);
    const auto dialect = with_decimals(header.dialect, csv, file.string());
    MappedRows rows(map, file.string());
    for_each_csv_row(
        csv, file.string(), [&](const CsvRowView& row) { rows.read_row(row); }, dialect,
        [&](const CsvRowView& row) { rows.skip_row(row); });
    if (rows.are_most_ragged())  // refuses the first of them
        for_each_csv_row(
            csv, file.string(), [](const CsvRowView&) {}, dialect);
    auto recordings = rows.take();
    for (auto& series : recordings) {
        series.file = file.string();
        series.flight = telemetry::flight_name(file);
        series.aircraft_id = map.aircraft_id;
        series.aircraft_name = map.aircraft_name;
        series.firmware = map.firmware;
        series.current_origin = map.current_origin;
    }
    return recordings;
}

}  // namespace flightwatt::flight
