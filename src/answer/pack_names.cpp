#include "answer/pack_names.h"

#include "base/clock_time.h"
#include "base/toml_reader.h"
#include "battery/battery.h"
#include "flight/flight_identity.h"

#include <algorithm>
#include <map>
#include <regex>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <fnmatch.h>

namespace flightwatt::answer {
namespace {

std::optional<double> optional_day_s(const TomlTable& table, const char* key) {
    const auto text = table.optional_string(key);
    if (!text) return std::nullopt;
    const auto day = parse_clock_time(*text);
    if (!day || !day->has_date || day->has_time)
        throw InputError(table.where(key), fmt::format("{} is '{}'", key, *text), "expected a day: \"2026-03-05\"");
    return day->time_s;
}

ListedPack read_pack(const TomlTable& table) {
    ListedPack pack;
    pack.name = table.string("name");
    pack.capacity_ah = optional_number_in(more_than_up_to(0.0, battery::max_capacity_ah), table, "capacity_ah",
                                          battery::capacity_hint);
    if (table.has("flights")) pack.flights = table.strings("flights");
    constexpr double day_s = 86400.0;
    pack.since_s = optional_day_s(table, "since");
    if (const auto last = optional_day_s(table, "until")) pack.until_s = *last + day_s;
    table.refuse_unknown_keys();
    pack.where = table.where("name");
    if (pack.name.empty()) throw InputError(pack.where, "name is empty", "give the text on the pack");
    return pack;
}

bool fits(const std::string& pattern, const PackUse& use) {
    return fnmatch(pattern.c_str(), use.flight.c_str(), 0) == 0;
}

bool is_in_days(const ListedPack& pack, const PackUse& use) {
    if (!pack.since_s && !pack.until_s) return true;
    return use.start_s && *use.start_s >= pack.since_s.value_or(*use.start_s) &&
           (!pack.until_s || *use.start_s < *pack.until_s);
}

/// Whether an entry assigns flights; others give only the label of the pack of their name.
bool assigns(const ListedPack& pack) { return !pack.flights.empty() || pack.since_s || pack.until_s; }

bool is_of(const ListedPack& pack, const PackUse& use) {
    const bool is_named =
        pack.flights.empty() || std::ranges::any_of(pack.flights, [&](const auto& of) { return fits(of, use); });
    return assigns(pack) && is_named && is_in_days(pack, use);
}

void assign(PackUse& use, const ListedPack& pack) {
    if (use.named_by == PackNaming::file)
        throw InputError(
            pack.where, fmt::format("pack '{}' and pack '{}' both have the flight {}", use.pack, pack.name, use.flight),
            "name it in one of them");
    use.pack = pack.name;
    use.named_by = PackNaming::file;
}

/// Folders may be of days, and are then no packs.
bool has_date(const std::string& folder) {
    static const std::regex date("(19|20)[0-9]{2}[-_.]?[01][0-9]|[0-9]{2}[-_.][0-9]{2}[-_.][0-9]{2}");
    return std::regex_search(folder, date);
}

void name_by_folders(std::vector<PackUse>& uses, std::vector<std::string>& notes) {
    std::map<std::string, std::set<std::string>> folders;  // by aircraft
    for (const auto& use : uses) folders[use.aircraft].insert(use.pack.empty() ? use.folder : "");
    for (const auto& [aircraft, names] : folders) {
        if (names.size() < 2 || names.contains("") || std::ranges::any_of(names, has_date)) continue;
        for (auto& use : uses)
            if (use.aircraft == aircraft) {
                use.pack = use.folder;
                use.named_by = PackNaming::folder;
            }
        notes.push_back(fmt::format("{}: the folders of its logs are taken for its packs: {}; packs.toml names others",
                                    aircraft, fmt::join(names, ", ")));
    }
}

void note_unfit(const std::vector<PackUse>& uses, const std::vector<ListedPack>& listed,
                std::vector<std::string>& notes) {
    for (const auto& pack : listed) {
        auto place = pack.where;  // notes go to pages, which name no folder
        place.file = std::filesystem::path(place.file).filename().string();
        const auto note = [&](const std::string& text) {
            notes.push_back(fmt::format("{}: pack '{}' {}", to_string(place), pack.name, text));
        };
        for (const auto& pattern : pack.flights)
            if (std::ranges::none_of(uses,
                                     [&](const auto& use) { return fits(pattern, use) && is_in_days(pack, use); }))
                note(fmt::format("has no flight '{}'", pattern));
        if (pack.flights.empty() && std::ranges::none_of(uses, [&](const auto& use) { return use.pack == pack.name; }))
            note("has no flight");
        std::set<std::string> serials;
        for (const auto& use : uses)
            if (use.pack == pack.name && !use.serial.empty()) serials.insert(use.serial);
        if (serials.size() > 1)
            note(fmt::format("has flights whose logs state several serial numbers: {}", fmt::join(serials, ", ")));
    }
}

}  // namespace

std::string to_string(PackNaming naming) {
    switch (naming) {
        case PackNaming::file:
            return "packs.toml";
        case PackNaming::serial:
            return "serial number";
        case PackNaming::folder:
            return "folder";
        case PackNaming::none:
            break;
    }
    return "none";
}

std::vector<PackUse> pack_uses(const flight::FlightData& data, std::vector<battery::DischargeRecord> records,
                               const std::string& folder) {
    const auto start_s = flight::start_clock_s(data.start_clock_s, data.flight);
    std::vector<PackUse> uses;
    bool is_first_pack = true;
    for (auto& record : records) {
        is_first_pack = is_first_pack && !record.is_other_pack;
        PackUse use;
        use.flight = record.flight;
        use.aircraft = flight::describe_aircraft(data.aircraft_id, data.aircraft_name);
        if (start_s) use.start_s = *start_s + record.time_s.front();
        if (is_first_pack) {  // the log states those of its beginning
            use.serial = data.pack_serial;
            use.cycles = data.pack_cycles;
        }
        use.folder = folder;
        use.record = std::move(record);
        uses.push_back(std::move(use));
    }
    return uses;
}

std::vector<ListedPack> read_packs_file(const std::filesystem::path& path) {
    const auto file = read_toml(path);
    require_known_format(file);
    std::vector<ListedPack> listed;
    file.collect_unknown_keys([&] {
        for (const auto& table : file.tables("pack")) {
            auto pack = read_pack(table);
            if (std::ranges::find(listed, pack.name, &ListedPack::name) != listed.end())
                throw InputError(pack.where, fmt::format("pack '{}' is there twice", pack.name), "join the two");
            listed.push_back(std::move(pack));
        }
        file.refuse_unknown_keys();
    });
    if (listed.empty()) throw InputError({path.string()}, "has no [[pack]]", "see packs.toml in docs/formats.md");
    return listed;
}

std::vector<ListedPack> read_packs_beside(const std::set<std::filesystem::path>& folders) {
    std::set<std::filesystem::path> lists;
    std::error_code none;
    for (const auto& folder : folders)
        if (const auto list = folder / "packs.toml"; !folder.empty() && std::filesystem::exists(list, none))
            lists.insert(std::filesystem::canonical(list));
    if (lists.size() > 1)
        throw InputError({lists.rbegin()->string()},
                         fmt::format("there is another list of packs, {}", lists.begin()->string()),
                         "join the two into one file");
    return lists.empty() ? std::vector<ListedPack>{} : read_packs_file(*lists.begin());
}

std::vector<std::string> name_packs(std::vector<PackUse>& uses, const std::vector<ListedPack>& listed) {
    std::vector<std::string> notes;
    for (auto& use : uses) {
        for (const auto& pack : listed)
            if (is_of(pack, use)) assign(use, pack);
        if (!use.pack.empty() || use.serial.empty()) continue;
        use.pack = use.serial;
        use.named_by = PackNaming::serial;
    }
    name_by_folders(uses, notes);
    for (auto& use : uses)
        for (const auto& pack : listed)
            if (pack.name == use.pack) use.label_ah = pack.capacity_ah;
    note_unfit(uses, listed, notes);
    return notes;
}

void choose_pack(std::vector<PackUse>& uses, const std::string& name) {
    std::set<std::string> names;
    for (const auto& use : uses)
        if (!use.pack.empty()) names.insert(use.pack);
    if (!names.contains(name))
        throw UsageError(names.empty() ? fmt::format("--pack {}: nothing names the packs of these flights: neither "
                                                     "packs.toml nor serial numbers nor folders",
                                                     name)
                                       : fmt::format("--pack {}: expected one of {}", name, fmt::join(names, ", ")));
    std::erase_if(uses, [&](const PackUse& use) { return use.pack != name; });
}

}  // namespace flightwatt::answer
