// Any bytes as a binary log: of each framing and version, into columns and as text, whole and in pieces.

#include "telemetry/binary_log.h"

#include "flight/telemetry_series.h"
#include "fuzz/fuzz_target.h"
#include "helpers/binary_definitions.h"

#include <algorithm>
#include <stdexcept>
#include <string>

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
        if (counts.messages + counts.unknown + counts.other_lengths + counts.other_frames != counts.frames ||
            counts.skipped_bytes + counts.zero_bytes > bytes.size() || characters > most_texts * bytes.size()) {
            throw std::logic_error("the counts of a decoder do not add up");
        }
    }
}

}  // namespace

void flightwatt::fuzz::run(std::string_view bytes) {
    static const auto messages = test::binary_dictionary();
    static const auto configuration = parse_log_configuration(test::binary_protocol, "messages.xml");
    for (const auto framing : {Framing::card, Framing::link, Framing::xbee}) decode(bytes, messages, framing);
    const auto framing = binary_framing(bytes);
    if (!framing) return;
    const auto log = read_binary_telemetry({bytes, *framing, "fuzz.LOG", "messages.xml", &messages}, configuration,
                                           flight::flight_messages());
    for (const auto& id : flight::telemetry_senders(log)) flight::flight_series(log, id);
}
