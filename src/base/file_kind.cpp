#include "base/error.h"
#include "base/input_file.h"

#include <algorithm>
#include <regex>
#include <vector>

#include <fmt/format.h>

namespace flightwatt {
namespace {

struct KnownFile {
    FileKind kind;
    std::string name;
    std::string remedy;  ///< how to get one; of foreign files what to do with it
    std::string sign;    ///< regular expression that finds it; empty: none does
};

/// In the order of the search. A recording of MAVLink begins with a time of this century in microseconds.
const std::vector<KnownFile>& known_files() {
    using enum FileKind;
    constexpr auto path_remedy = "a mission names it in its [path]; `flightwatt new-mission` writes a mission";
    static const std::vector<KnownFile> files{
        {foreign, "a bag of ROS", "", "^#ROSBAG"},
        {foreign, "a blackbox log of Betaflight or INAV", "", "^H Product:Blackbox"},
        {foreign, "a MATLAB file", "", "^MATLAB 5"},
        {foreign, "an HDF5 file", "", "^\x89HDF"},
        {foreign, "an SQLite database", "", "^SQLite format 3"},
        {foreign, "a PDF document", "", "^%PDF"},
        {foreign, "a picture", "", "^\x89PNG"},
        {foreign, "a program", "",
         "^\x7F"
         "ELF"},
        {log, "a log", "expected a .data log, .LOG or .tlm of Paparazzi, a .bin, .ulg or .tlog, or a CSV of a flight",
         "(^|\n)([0-9.]+ [^ \n]+ [A-Z]|FMT, ?128)|^(\xA3\x95\x80|ULog\x01|\\x00[\\x03-\\x0E][\\s\\S]{6}[\xFD\xFE])"},
        {unknown, "", "", "[\\x00-\\x08]"},  // binary: a log, or nothing that is known
        {mission, "a mission", "write one with `flightwatt new-mission`", R"((^|\n)\[*(battery|mechanical)\b)"},
        {mechanical_model, "a mechanical model", "fit one with `flightwatt batch` or `fit`", R"((^|\n)\[*takeoff\b)"},
        {battery, "a battery", "identify one with `flightwatt battery`", R"((^|\n)resistance_ohm\b)"},
        {disturbances, "a list of disturbances", "missions/disturbances/ has examples", R"((^|\n)\[+disturbance\b)"},
        {specification, "a specification of flightwatt profile", "docs/formats.md describes one",
         R"((^|\n)(\[sampler|idle_s|above_idle))"},
        {profile, "a power profile", "measure one with `flightwatt profile`", ""},
        {foreign, "the definitions of a log (.log)", "name its .data instead", "<configuration"},
        {foreign, "a flight plan of Paparazzi", path_remedy, "<flight_plan"},
        {foreign, "a web page", "", "<(!DOCTYPE )?html"},
        {foreign, "an XML file", "", R"(^\s*<)"},
        {foreign, "a plan of QGroundControl", path_remedy, "\"fileType\""},
        {foreign, "a JSON file", "", R"(^\s*\{)"},
        {foreign, "a list of waypoints of ArduPilot", path_remedy, "^QGC WPL"},
        {table, "a table (CSV)", "", R"(^(#[^\n]*\n)*[^#=\n]*,)"}};
    return files;
}

/// The file whose sign the text has; nullptr: none. The beginning of a text decides; a longer one would take the
/// recursion of regular expressions far.
const KnownFile* find_known_file(std::string_view text) {
    static const auto signs = [] {
        std::vector<std::regex> all;
        for (const auto& file : known_files()) all.emplace_back(file.sign);
        return all;
    }();
    const auto begin = text.substr(0, 4096);
    for (std::size_t i = 0; i < signs.size(); ++i)
        if (!known_files()[i].sign.empty() && std::regex_search(begin.begin(), begin.end(), signs[i]))
            return &known_files()[i];
    return nullptr;
}

}  // namespace

FileKind kind_of_text(std::string_view text) {
    const auto* found = find_known_file(text);
    return found != nullptr ? found->kind : FileKind::unknown;
}

void require_kind(std::string_view text, FileKind expected, const std::string& file) {
    const auto& wanted = *std::ranges::find(known_files(), expected, &KnownFile::kind);
    const bool has_columns = expected == FileKind::log || expected == FileKind::profile;
    if (!has_columns && text.find_first_not_of(" \t\r\n") == std::string_view::npos)
        throw InputError({file}, fmt::format("is empty, expected {}", wanted.name), wanted.remedy);
    const auto* found = find_known_file(text);
    if (found == nullptr || found->kind == expected || found->kind == FileKind::unknown) return;
    if (has_columns && found->kind == FileKind::table) return;
    const bool has_own_remedy = found->kind == FileKind::foreign && !found->remedy.empty();
    throw InputError({file}, fmt::format("is {}, not {}", found->name, wanted.name),
                     has_own_remedy ? found->remedy : wanted.remedy);
}

}  // namespace flightwatt
