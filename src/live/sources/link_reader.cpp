#include "live/sources/link_reader.h"

#include <string>

namespace flightwatt::live {

LinkReader::LinkReader(const telemetry::MessageDictionary& dictionary, std::optional<telemetry::Framing> framing,
                       MessageQueue& queue)
    : queue_(queue), decoder_(dictionary, framing) {}

void LinkReader::push(std::string_view bytes) {
    decoder_.push(bytes, [this](const auto& message) { hand_on(message); });
    count();
}

void LinkReader::flush() {
    decoder_.flush([this](const auto& message) { hand_on(message); });
    count();
}

void LinkReader::hand_on(const telemetry::LinkMessage& message) {
    // What the ground says to an aircraft bears its own id, 0, and is none of its telemetry.
    if (message.class_id != telemetry::MessageDictionary::telemetry_class)
        return queue_.count("messages of other classes than telemetry");
    queue_.push({message.time_s, std::string(message.text)});
}

void LinkReader::count() {
    const auto& now = decoder_.counts();
    queue_.count("frames of messages that are not defined", now.unknown - counted_.unknown);
    queue_.count("frames of another length than their message's", now.other_lengths - counted_.other_lengths);
    queue_.count("bytes between frames", now.skipped_bytes - counted_.skipped_bytes);
    counted_ = now;
}

}  // namespace flightwatt::live
