#pragma once

#include "base/error.h"
#include "base/statistics.h"
#include "battery/discharge_record.h"
#include "battery/identified_battery.h"
#include "flight/flight_data.h"

#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <vector>

/// Which pack each flight was flown on.
namespace flightwatt::answer {

/// What names the pack of a flight, in the order of precedence.
enum class PackNaming { file, serial, folder, none };

/// "packs.toml", "serial number", "folder", "none".
std::string to_string(PackNaming naming);

/// One discharge of a pack: a log, or its part between two changes of the pack.
struct PackUse {
    std::string flight;  ///< NAME; after a change of the pack NAME#2
    std::string aircraft;
    std::optional<double> start_s;  ///< Unix time of its first sample
    std::string serial;             ///< as the log states it
    std::optional<double> cycles;   ///< likewise
    std::string folder;             ///< name of the log's folder
    battery::DischargeRecord record;
    std::string pack = {};  ///< its name by name_packs(); may be empty
    PackNaming named_by = PackNaming::none;
    std::optional<double> label_ah = {};  ///< the capacity on the pack's label
    // By make_pack_ledger(), where its flights determine them:
    std::optional<battery::IdentifiedFlight> found = {};
    double mean_capacity_ah = 0.0;  ///< of the flights that `found` compares
    std::string continues = {};     ///< the use at whose end this one begins: the pack was not charged between
};

/// The uses of packs in a flight, whose records are these; `folder` is that of its log.
std::vector<PackUse> pack_uses(const flight::FlightData& data, std::vector<battery::DischargeRecord> records,
                               const std::string& folder);

/// A pack of packs.toml (docs/formats.md).
struct ListedPack {
    std::string name;
    std::optional<double> capacity_ah;
    std::vector<std::string> flights;  ///< names, or patterns with * and ?
    std::optional<double> since_s;     ///< Unix times
    std::optional<double> until_s;     ///< the end of its day
    Location where;
};

/// Throws InputError for unknown keys, a name that is there twice, and values that are not possible.
std::vector<ListedPack> read_packs_file(const std::filesystem::path& path);

/// Reads packs.toml in one of the folders; nothing where none has one. Throws InputError where two have one.
std::vector<ListedPack> read_packs_beside(const std::set<std::filesystem::path>& folders);

/// Names the pack of each use: by the list, else by the log's serial number, else, where the logs of an aircraft are in
/// several folders without dates in their names, by the folder. Returns notes: how packs were named, lines of the list
/// that fit no flight, serial numbers that contradict it. Throws InputError for a flight that two packs claim.
std::vector<std::string> name_packs(std::vector<PackUse>& uses, const std::vector<ListedPack>& listed);

/// Leaves the uses of one pack. Throws UsageError with the names that there are for another one.
void choose_pack(std::vector<PackUse>& uses, const std::string& name);

}  // namespace flightwatt::answer
