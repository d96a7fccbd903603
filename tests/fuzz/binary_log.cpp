// Any bytes as a binary log: of each framing and version, as text, whole and in pieces; and by each of some definitions
// to the phases of every aircraft.

#include "telemetry/binary_log.h"

#include "base/error.h"
#include "flight/segment.h"
#include "flight/telemetry_series.h"
#include "fuzz/fuzz_target.h"
#include "helpers/binary_definitions.h"
#include "helpers/selected_tracks.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

using namespace flightwatt::telemetry;

/// Every byte is of a frame, skipped or room: more would have been read twice, or beyond the end.
void decode(std::string_view bytes, const MessageDictionary& messages, Framing framing) {
    constexpr std::size_t most_texts = 1000;
    for (const std::size_t piece : {bytes.size() + 1, std::size_t{7}}) {
        LinkDecoder decoder(messages, framing);
        std::size_t characters = 0;
        const auto sink = [&](const LinkMessage& message) { characters += message.text.size(); };
        for (auto rest = bytes; !rest.empty(); rest.remove_prefix(std::min(piece, rest.size())))
            decoder.push(rest.substr(0, piece), sink);
        decoder.flush(sink);
        const auto& counts = decoder.counts();
        if (counts.messages + counts.unknown + counts.length_mismatches + counts.non_message_frames != counts.frames ||
            counts.skipped_bytes + counts.padding_bytes > bytes.size() || characters > most_texts * bytes.size()) {
            throw std::logic_error("the counts of a decoder do not add up");
        }
    }
}

struct Definitions {
    MessageDictionary messages;
    LogConfiguration configuration;
};

/// Messages of all field types, those of synthetic logs and, where they are, of pprzlink: of each, seeds hold a flight.
std::vector<Definitions> all_definitions() {
    std::vector<Definitions> all{
        {flightwatt::test::binary_dictionary(),
         parse_log_configuration(flightwatt::test::binary_protocol, "messages.xml")},
    };
    for (const auto* file : {"/logs/opterra_synthetic_01.log", "/../shared/pprzlink/messages.xml"}) {
        const auto path = std::filesystem::path(std::string(FLIGHTWATT_SOURCE_DIR) + file);
        if (std::filesystem::exists(path)) {
            all.push_back({read_message_dictionary(path), read_log_configuration(path)});
        } else {
            std::fprintf(stderr, "SKIPPED: %s is not here\n", path.c_str());
        }
    }
    const auto wanted = flightwatt::flight::flight_messages();
    for (auto& definitions : all) {
        std::erase_if(definitions.configuration.messages, [&](const auto& message) {
            return std::ranges::find(wanted, message.first, &MessageRequest::message) == wanted.end();
        });  // they are copied for each input
    }
    return all;
}

/// Resampling takes long in a log of days: one in 32 of more than an hour is segmented.
bool is_segmented(const flightwatt::flight::Track& power, std::string_view bytes) {
    return power.empty() || power.time_s.back() - power.time_s.front() <= 3600.0 ||
           std::hash<std::string_view>{}(bytes) % 32 == 0;
}

void segment(std::string_view bytes, Framing framing, const Definitions& definitions) {
    namespace flight = flightwatt::flight;
    const auto log = read_binary_telemetry({bytes, framing, "fuzz.LOG", "messages.xml", &definitions.messages},
                                           definitions.configuration, flight::flight_messages());
    for (const auto& id : flight::telemetry_senders(log)) {
        const auto series = flight::flight_series(log, id);
        const auto tracks = select_tracks(series);
        flight::require_power(tracks);
        if (is_segmented(tracks.power_w, bytes)) flight::segment(tracks);
    }
}

}  // namespace

void flightwatt::fuzz::run(std::string_view bytes) {
    static const auto definitions = all_definitions();
    for (const auto framing : {Framing::card, Framing::link, Framing::xbee})
        decode(bytes, definitions.front().messages, framing);
    const auto framing = detect_binary_framing(bytes);
    if (!framing) return;
    for (const auto& each : definitions) {
        try {
            segment(bytes, *framing, each);
        } catch (const InputError&) {
            // They are another aircraft's.
        }
    }
}
