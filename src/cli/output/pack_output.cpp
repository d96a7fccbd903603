#include "cli/output/pack_output.h"

#include "base/units.h"
#include "batch/manifest.h"
#include "cli/options.h"
#include "cli/output/flight_options.h"

#include <set>

namespace flightwatt::answer {

Fields<Pack> record_fields(const Pack*) {
    using R = Pack;
    using V = PackCondition;
    using T = PackTrend;
    const auto day = [](const std::optional<double>& time_s) {
        return time_s ? day_text(*time_s / seconds_per_day) : std::string();
    };
    const auto percent_of_label = [](const R& pack) -> std::optional<double> {
        if (!pack.capacity_ah || !pack.label_ah) return std::nullopt;
        return units::percentage(*pack.capacity_ah, *pack.label_ah);
    };
    return list_fields<R>(
        field("pack", &R::name, "name of the pack, or `unnamed`", csv_column{}, column{}),
        field(
            "named_by", [](const R& pack) { return to_string(pack.named_by); },
            "`packs.toml`, `serial number`, `folder` or `none`", csv_column{}, column{"named by"}),
        field("may_be_several", &R::may_be_several, "nothing shows that these flights are of one pack", csv_column{}),
        field("aircraft", &R::aircraft, "aircraft that flew it"),
        field(
            "flights", [](const R& pack) { return pack.uses.size(); }, "flights, and parts of logs between packs",
            csv_column{}, column{}),
        field(
            "first", [day](const R& pack) { return day(pack.first_s); }, "day (UTC) of the first dated flight",
            csv_column{}, column{}),
        field(
            "last", [day](const R& pack) { return day(pack.last_s); }, "and of the last", csv_column{}, column{}),
        field("energy_wh", &R::energy_wh, "drawn in these flights, also on the ground", csv_column{},
              column{"Wh", ".0f"}),
        field("charge_ah", &R::charge_ah, "likewise", csv_column{}),
        field("cycles", &R::cycles, "charge cycles, as the last log states", csv_column{},
              column_if_any("cycles", ".0f")),
        field("equivalent_cycles", &R::equivalent_cycles, "charge drawn in these flights over the capacity",
              csv_column{}, column{"full cycles", ".1f"}),
        field("partly_used", &R::partly_used, "flights that begin where another one ended, without a charge between",
              csv_column{}, column{"partly used"}),
        field("cells", &R::cells, "in series", csv_column{}),
        field("resistance_ohm", &R::resistance_ohm,
              "mean of the last flights of like temperature and charge, at most 5", csv_column{}, column{"ohm", ".4f"}),
        field("resistance_ohm_interval_95", &R::resistance_interval_ohm, "", csv_column{}),
        field("temperature_c", &R::temperature_c, "in these flights", csv_column{}, column_if_any("degC", ".0f")),
        field("temperature_of", &R::temperature_of, "`battery` (at take-off) or `air`; empty: unknown", csv_column{}),
        field("start_charge_percent", &R::start_charge_percent, "state of charge at their start", csv_column{}),
        field("resistance_change_percent", at(&R::resistance, &T::change_percent),
              "from the first flight to the last, with the RC pair's", csv_column{}, column{"change %", ".0f"}),
        field("resistance_change_percent_interval_95", at(&R::resistance, &T::change_interval_percent), "",
              csv_column{}),
        field("label_capacity_ah", &R::label_ah, "by packs.toml", csv_column{}),
        field("capacity_ah", &R::capacity_ah, "by the flights", csv_column{}, column{"Ah", ".2f"}),
        field("capacity_ah_interval_95", &R::capacity_interval_ah, "", csv_column{}),
        field("capacity_percent_of_label", percent_of_label, "", csv_column{}),
        field("capacity_change_percent", at(&R::capacity, &T::change_percent), "from the first flight to the last",
              csv_column{}),
        field("capacity_change_percent_interval_95", at(&R::capacity, &T::change_interval_percent), "", csv_column{}),
        field("rest_voltage_v", &R::rest_voltage_v, "before flights that begin full: mean", csv_column{}),
        field("rest_voltage_spread_v", &R::rest_voltage_spread_v, "highest less lowest of these", csv_column{}),
        field(
            "health", [](const R& pack) { return to_string(pack.condition.health); },
            "`healthy`, `watch`, `retire` or `unknown`", csv_column{}, column{}),
        field("reason", at(&R::condition, &V::reason), "why", csv_column{}),
        field("mission_until", &R::mission_until, "until when it flies the mission of --mission with its reserve",
              csv_column{}, column_if_any("mission")));
}

}  // namespace flightwatt::answer

namespace flightwatt::cli {

void add_pack_options(Options& options, PackArguments& arguments) {
    options.add("packs-file", arguments.list, {.value = "FILE"},
                "which flights are of which pack; default: packs.toml in the folder of the inputs");
    options.add("pack", arguments.pack, {.value = "NAME"},
                "the flights of this pack alone: its name in packs.toml, serial number or folder");
}

std::filesystem::path LogPlaces::folder(const std::filesystem::path& file) {
    const auto out = file.parent_path().parent_path();
    if (!file.string().ends_with(batch::series_suffix) || !std::filesystem::exists(out / batch::manifest_name))
        return std::filesystem::absolute(file).parent_path();
    auto [logs, is_new] = logs_.try_emplace(out);
    if (is_new)
        for (const auto& log : batch::read_manifest(out)) logs->second.emplace(log.flight, log.place);
    const auto flight = flight_of_file(file);
    const auto log = logs->second.find(flight.substr(0, flight.rfind('@')));
    return log == logs->second.end() ? std::filesystem::path() : std::filesystem::path(log->second).parent_path();
}

void name_packs(const StageCall& call, const PackArguments& arguments, const std::vector<std::string>& files,
                std::vector<answer::PackUse>& uses) {
    std::set<std::filesystem::path> folders;
    LogPlaces places;
    std::error_code none;
    for (const auto& input : call.inputs)
        if (std::filesystem::is_directory(input, none)) folders.insert(input);
    for (const auto& file : files) folders.insert(places.folder(file));
    const auto listed = arguments.list ? answer::read_packs_file(*arguments.list) : answer::read_packs_beside(folders);
    for (const auto& text : answer::name_packs(uses, listed)) note(call, text);
    if (arguments.pack) answer::choose_pack(uses, *arguments.pack);
}

}  // namespace flightwatt::cli
