#include "cli/output/source_options.h"

#include "base/error.h"
#include "cli/numeric_options.h"
#include "live/sources.h"
#include "telemetry/binary_log.h"
#include "telemetry/log_configuration.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <vector>

#include <fmt/format.h>

namespace flightwatt::cli {
namespace {

constexpr std::array links{"udp", "serial", "ivy"};

/// Whether the file that is to be followed is binary: by its content, and while it has none by its name.
bool is_binary_log(const std::filesystem::path& path) {
    constexpr std::size_t enough = 65'536;
    std::error_code error;
    if (!std::filesystem::is_regular_file(path, error)) return false;  // rejected when it is followed
    std::string bytes(enough, '\0');
    std::ifstream file(path, std::ios::binary);
    file.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    bytes.resize(static_cast<std::size_t>(std::max<std::streamsize>(0, file.gcount())));
    if (!bytes.empty()) return telemetry::detect_binary_framing(bytes).has_value();
    const auto ending = path.extension().string();
    return ending == ".LOG" || ending == ".tlm" || ending == ".TLM" || ending == ".bin";
}

telemetry::MessageDictionary read_definitions(const StageCall& call, const std::string& what) {
    if (const auto file = definitions_of_source(call)) return telemetry::read_message_dictionary(*file);
    throw InputError({what}, "frames need the definitions of their messages",
                     "give --log FILE.log of the aircraft, or --messages messages.xml");
}

std::unique_ptr<live::MessageSource> follow(const StageCall& call, const std::string& file) {
    if (!is_binary_log(file)) return live::follow_data_file(file);
    return live::follow_binary_log(file, read_definitions(call, file));
}

void refuse_other_sources(const StageCall& call) {
    std::vector<std::string> given;
    if (!call.inputs.empty()) given.emplace_back("-");
    for (const auto* option : {"follow", "udp", "serial", "ivy"}) {
        if (call.has(option)) given.push_back(std::string("--") + option);
    }
    if (given.empty())
        throw UsageError(
            "no source given: expected --follow FILE, --udp PORT, --serial DEVICE:BAUD, --ivy ADDRESS:PORT or - (the "
            "standard input)");
    if (given.size() > 1)
        throw UsageError(fmt::format("{} and {} exclude each other: give one of them", given[0], given[1]));
}

}  // namespace

void add_source_options(boost::program_options::options_description& options) {
    auto add = options.add_options();
    add("follow", input_file("FILE"), "a log that is being written: a .data, or a binary one");
    add("udp", value("PORT"), "Paparazzi's link frames that come in on a UDP port (4242), or at ADDRESS:PORT");
    add("serial", value("DEVICE:BAUD"), "link frames, or an XBee's packets, on a serial line (/dev/ttyUSB0:57600)");
    add("ivy", value("ADDRESS:PORT"), "an Ivy bus (127.255.255.255:2010)");
    add("clock-factor", value<double>("X"),
        "messages without a time come in X times as fast as they were: of a log that is played (1)");
    add("log", input_file("FILE.log"),
        "the telemetry's definitions; by default the .log beside a file that is followed, else the built-in ones, which "
        "frames lack");
    add("messages", input_file("FILE"), "the same from a messages.xml");
}

std::optional<std::string> definitions_of_source(const StageCall& call) {
    if (call.has("messages") && call.has("log"))
        throw UsageError("--messages and --log exclude each other: give one of them");
    if (call.has("messages")) return call.get<std::string>("messages");
    if (call.has("log")) return call.get<std::string>("log");
    if (!call.has("follow")) return std::nullopt;
    const auto beside = telemetry::find_log_file(call.get<std::string>("follow"));
    return beside ? std::optional(beside->string()) : std::nullopt;
}

std::unique_ptr<live::MessageSource> open_source(const StageCall& call) {
    if (!call.inputs.empty() && call.inputs.front() != "-") {
        throw UsageError(
            fmt::format("'{0}': expected - (the standard input); to follow a file: --follow {0}", call.inputs.front()));
    }
    refuse_other_sources(call);
    const auto factor = positive_option(call, "clock-factor", "times as fast");
    const bool is_link = std::any_of(links.begin(), links.end(), [&](const char* link) { return call.has(link); });
    if (factor && !is_link) throw UsageError("--clock-factor goes with --udp, --serial or --ivy");
    if (call.has("follow")) return follow(call, call.get<std::string>("follow"));
    if (call.has("ivy")) return live::open_ivy_bus(call.get<std::string>("ivy"), factor.value_or(1.0));
    if (call.has("udp")) {
        const auto at = call.get<std::string>("udp");
        return live::open_udp(at, read_definitions(call, "--udp " + at), factor.value_or(1.0));
    }
    if (call.has("serial")) {
        const auto line = call.get<std::string>("serial");
        return live::open_serial(line, read_definitions(call, "--serial " + line), factor.value_or(1.0));
    }
    return live::standard_input();
}

}  // namespace flightwatt::cli
