#include "telemetry/log_configuration.h"

#include "base/atomic_file.h"
#include "base/error.h"
#include "base/number.h"
#include "telemetry/autopilot/ulog_table_name.h"
#include "telemetry/data_file.h"

#include <algorithm>
#include <initializer_list>
#include <string_view>

#include <fmt/format.h>
#include <pugixml.hpp>

namespace flightwatt::telemetry {
namespace {

/// Prefers the messages of class "telemetry", which an aircraft sends; other classes may reuse their names.
void read_messages(std::vector<ProtocolMessage> protocol, LogConfiguration& configuration) {
    std::stable_partition(protocol.begin(), protocol.end(),
                          [](const auto& message) { return message.class_name == "telemetry"; });
    for (auto& message : protocol) {
        auto name = message.definition.name;
        configuration.messages.emplace(std::move(name), std::move(message.definition));
    }
}

/// Position of the '>' of the tag that opens at `begin`, outside of quoted values. npos if another tag begins first or
/// the tag is too long: then a quote is missing.
std::size_t tag_end(std::string_view text, std::size_t begin) {
    constexpr std::size_t max_tag = 4096;
    char quote = '\0';
    for (std::size_t i = begin + 1; i < std::min(text.size(), begin + max_tag); ++i) {
        const char c = text[i];
        if (quote != '\0') {
            if (c == '\\')
                ++i;
            else if (c == quote)
                quote = '\0';
        } else if (c == '"' || c == '\'') {
            quote = c;
        } else if (c == '>') {
            return i;
        } else if (c == '<') {
            break;
        }
    }
    return std::string_view::npos;
}

/// Calls `use` with each opening tag `name` in `text`, read as an element of its own.
template <typename Use>
void for_each_tag(std::string_view text, std::string_view name, Use&& use) {
    const std::string opening = fmt::format("<{}", name);
    for (auto at = text.find(opening); at != std::string_view::npos; at = text.find(opening, at + 1)) {
        const auto after = at + opening.size();
        if (after >= text.size() || (text[after] != ' ' && text[after] != '\t' && text[after] != '\n')) continue;
        const auto end = tag_end(text, at);
        if (end == std::string_view::npos) continue;
        std::string tag(text.substr(at, end - at));
        if (tag.back() != '/') tag += '/';
        tag += '>';
        pugi::xml_document document;
        if (document.load_string(tag.c_str())) use(document.document_element());
    }
}

AircraftConfiguration read_aircraft(std::string_view text, const pugi::xml_node& node) {
    AircraftConfiguration aircraft;
    aircraft.id = xml_attribute(node, "ac_id");
    aircraft.name = xml_attribute(node, "name");
    for_each_tag(text, "flight_plan", [&](const pugi::xml_node& plan) {
        if (!aircraft.ground_altitude_m) aircraft.ground_altitude_m = parse_number(xml_attribute(plan, "ground_alt"));
    });
    for_each_tag(text, "firmware", [&](const pugi::xml_node& firmware) {
        if (aircraft.firmware.empty() || aircraft.firmware == "test_progs")
            aircraft.firmware = xml_attribute(firmware, "name");
    });
    int position = 0;
    for_each_tag(text, "block", [&](const pugi::xml_node& block) {
        const auto number = parse_unsigned(xml_attribute(block, "no"));
        aircraft.block_names.emplace(number ? static_cast<int>(*number) : position, xml_attribute(block, "name"));
        ++position;
    });
    for_each_tag(text, "define", [&](const pugi::xml_node& define) {
        const auto name = xml_attribute(define, "name");
        if (name.starts_with("MilliAmpereOfAdc")) {
            aircraft.current_origin = CurrentOrigin::sensor;
        } else if (name.starts_with("MILLIAMP_AT_FULL_THROTTLE") && aircraft.current_origin == CurrentOrigin::unknown) {
            aircraft.current_origin = CurrentOrigin::throttle;
        }
    });
    return aircraft;
}

void read_all_aircraft(std::string_view text, LogConfiguration& configuration) {
    constexpr std::string_view closing = "</aircraft>";
    std::size_t at = 0;
    while ((at = text.find("<aircraft ", at)) != std::string_view::npos) {
        const auto end = std::min(text.find(closing, at), text.size());
        const auto element = text.substr(at, end - at);
        for_each_tag(element.substr(0, tag_end(element, 0) + 1), "aircraft", [&](const pugi::xml_node& node) {
            auto aircraft = read_aircraft(element, node);
            auto id = aircraft.id;
            configuration.aircraft.emplace(std::move(id), std::move(aircraft));
        });
        at = end;
    }
}

bool is_same_file(const std::filesystem::path& a, const std::filesystem::path& b) {
    std::error_code error;
    return std::filesystem::equivalent(a, b, error) && !error;
}

}  // namespace

bool begins_as_xml(const std::filesystem::path& path) {
    const auto bytes = beginning_of_file(path);
    const auto first = bytes.find_first_not_of(" \t\r\n");
    return first != std::string::npos && (bytes[first] == '<' || bytes[first] == '\xEF');
}

LogConfiguration parse_log_configuration(const std::string& text, const std::filesystem::path& file) {
    LogConfiguration configuration;
    configuration.file = file;
    read_messages(parse_protocol(text, file), configuration);
    for_each_tag(text, "configuration", [&](const pugi::xml_node& node) {
        const auto time_s = parse_number(xml_attribute(node, "time_of_day"));
        if (!configuration.time_of_day_s && time_s && *time_s > 0.0) configuration.time_of_day_s = time_s;
    });
    read_all_aircraft(text, configuration);
    return configuration;
}

LogConfiguration read_log_configuration(const std::filesystem::path& path) {
    return parse_log_configuration(read_file(path, max_log_configuration_bytes), path);
}

std::string flight_name(const std::filesystem::path& data_file) {
    auto name = data_file.filename().string();
    const auto strip_first = [&](std::initializer_list<std::string_view> endings) {
        const auto found = std::ranges::find_if(endings, [&](auto ending) { return name.ends_with(ending); });
        if (found != endings.end()) name.resize(name.size() - found->size());
    };
    strip_first({".gz", ".bz2", ".xz", ".zst"});
    strip_first({".series.csv", ".data", ".csv", ".CSV", ".tsv", ".txt", ".LOG", ".log", ".tlm", ".TLM", ".bin", ".BIN",
                 ".ulg", ".px4log", ".tlog", ".TLOG"});
    return without_topic(std::move(name));
}

std::optional<std::filesystem::path> find_log_file(const std::filesystem::path& data_file) {
    const auto flight = flight_name(data_file);
    std::vector<std::string> stems{flight};
    if (flight.ends_with("_SD")) stems.push_back(flight.substr(0, flight.size() - 3));
    // The .log of a card's X.LOG is X.log; that of X.tlm may be X.LOG.
    for (const auto& stem : stems) {
        for (const auto* ending : {".log", ".LOG", ".Log"}) {
            const auto candidate = data_file.parent_path() / (stem + ending);
            if (is_same_file(candidate, data_file)) continue;
            std::error_code error;
            const bool is_usual = ending == std::string_view(".log");
            if (std::filesystem::is_regular_file(candidate, error)) {
                if (is_usual || begins_as_xml(candidate)) return candidate;
                continue;
            }
            // A .log that cannot be read is returned: reading it reports the reason.
            const bool is_absent = !error || error == std::errc::no_such_file_or_directory ||
                                   error == std::errc::not_a_directory || error == std::errc::filename_too_long;
            if (is_usual && !is_absent) return candidate;
        }
    }
    return std::nullopt;
}

}  // namespace flightwatt::telemetry
