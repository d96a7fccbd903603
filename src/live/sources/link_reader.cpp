#include "live/sources/link_reader.h"

#include "live/sources/link_tally.h"

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
    if (message.class_id != telemetry::MessageDictionary::telemetry_class) return queue_.count(other_class);
    queue_.push({message.time_s, std::string(message.text)});
}

void LinkReader::count() {
    report_unusable(decoder_.counts(), counted_,
                    [this](const char* reason, std::size_t times) { queue_.count(reason, times); });
    counted_ = decoder_.counts();
}

}  // namespace flightwatt::live
