#pragma once

#include "base/text_table.h"
#include "cli/stage.h"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

/// Records as JSON, which lists their fields once: tables and CSV name the fields that they show.
namespace flightwatt::cli {

/// A row a record; '-' for what is null or absent, "yes" and "no" for truth. A column names the field that it shows, the
/// form of numbers with fractions as fmt has it, and its heading where that is not the field: "energy_wh .3f: energy
/// [Wh]". "utility?" is left out where no record has it; "check/rms_v" is a field of a record within the record,
/// "interval/0" the first of a list. Numbers of columns that name no form have the `usual_form`; empty: all digits.
TextTable table_of(const Json& records, const std::vector<std::string_view>& columns, std::string_view usual_form = {});

/// The same as CSV, so many digits a number; what a record does not know is an empty cell.
std::string csv_of(const Json& records, const std::vector<std::string_view>& columns, int digits = 0);

/// A list of what `json_of` makes of each.
template <typename Records, typename ToJson>
Json list_json(const Records& records, const ToJson& json_of) {
    auto list = Json::array();
    for (const auto& record : records) list.push_back(json_of(record));
    return list;
}

/// An interval with members low and high; null for one that is not known.
template <typename Interval>
Json interval_json(const Interval& interval) {
    return {{"low", interval.low}, {"high", interval.high}};
}
template <typename Interval>
Json interval_json(const std::optional<Interval>& interval) {
    return interval ? interval_json(*interval) : Json();
}

}  // namespace flightwatt::cli
