#include "live/sources/binary_log_source.h"

#include "live/sources/link_tally.h"

#include <utility>

namespace flightwatt::live {

BinaryLogSource::BinaryLogSource(const std::filesystem::path& path, telemetry::MessageDictionary definitions)
    : followed_(path, "expected the log that an autopilot or a modem's program writes"),
      definitions_(std::move(definitions)),
      decoder_(definitions_) {}

void BinaryLogSource::receive(std::chrono::milliseconds timeout, std::vector<IncomingMessage>& messages) {
    const auto piece = followed_.read(timeout, true);
    if (piece.anew) restart_decoder(messages);
    const auto sink = [&](const telemetry::LinkMessage& message) { forward(message, messages); };
    if (!piece.bytes.empty()) decoder_.push(piece.bytes, sink);
    count();
}

void BinaryLogSource::restart_decoder(std::vector<IncomingMessage>& messages) {
    decoder_.flush([&](const telemetry::LinkMessage& message) { forward(message, messages); });
    count();
    decoder_ = telemetry::LinkDecoder(definitions_);
    counted_ = {};
    ++report_.restarts;
    restarted_ = true;
}

void BinaryLogSource::forward(const telemetry::LinkMessage& message, std::vector<IncomingMessage>& messages) {
    if (message.class_id != telemetry::MessageDictionary::telemetry_class) {
        ++report_.unusable[other_class];
        return;
    }
    ++report_.messages;
    messages.push_back({message.time_s, std::string(message.text), std::exchange(restarted_, false)});
}

void BinaryLogSource::count() {
    report_unusable(decoder_.counts(), counted_, [this](const char* reason, std::size_t times) {
        if (times > 0) report_.unusable[reason] += times;
    });
    counted_ = decoder_.counts();
}

}  // namespace flightwatt::live
