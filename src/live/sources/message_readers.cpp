#include "live/sources/message_readers.h"

#include "base/number.h"

#include <cmath>
#include <utility>

namespace flightwatt::live {

void SourceReport::count(std::string_view reason, std::size_t times) {
    if (times > 0) unusable[std::string(reason)] += times;
}

std::optional<IncomingMessage> message_of_line(std::string_view line) {
    const auto blank = line.find(' ');
    if (blank == std::string_view::npos || blank + 1 >= line.size()) return std::nullopt;
    const auto time_s = parse_number(line.substr(0, blank));
    if (!time_s || !std::isfinite(*time_s)) return std::nullopt;
    return IncomingMessage{time_s, std::string(line.substr(blank + 1))};
}

std::size_t LineBuffer::push(std::string_view bytes, std::vector<std::string>& lines) {
    std::size_t overlong = 0;
    while (!bytes.empty()) {
        const auto line_break = bytes.find('\n');
        const auto piece = bytes.substr(0, line_break);
        if (!dropping_ && rest_.size() + piece.size() > max_line) {
            dropping_ = true;
            ++overlong;
            rest_.clear();
        }
        if (!dropping_) rest_ += piece;
        if (line_break == std::string_view::npos) break;
        if (!dropping_) lines.push_back(take_partial_line());
        dropping_ = false;
        bytes.remove_prefix(line_break + 1);
    }
    return overlong;
}

std::string LineBuffer::take_partial_line() {
    auto line = std::exchange(rest_, {});
    if (!line.empty() && line.back() == '\r') line.pop_back();
    return line;
}

void TextReader::push(std::string_view bytes) {
    std::vector<std::string> lines;
    sink_.count("lines longer than any message", buffer_.push(bytes, lines));
    for (const auto& line : lines) read(line);
}

void TextReader::read(const std::string& line) {
    if (line.empty()) return;
    if (auto message = message_of_line(line)) return sink_.push(std::move(*message));
    sink_.count("lines that are no message (TIME SENDER NAME ...)", 1);
}

LinkReader::LinkReader(MessageSink& sink, Definitions definitions, std::optional<telemetry::Framing> framing,
                       std::optional<telemetry::LinkVersion> version)
    : sink_(sink), definitions_(std::move(definitions)), framing_(framing), decoder_(*definitions_, framing, version) {}

void LinkReader::push(std::string_view bytes) {
    decoder_.push(bytes, [this](const auto& message) { forward(message); });
    count_unusable();
}

void LinkReader::flush() {
    decoder_.flush([this](const auto& message) { forward(message); });
    count_unusable();
}

void LinkReader::restart() {
    flush();
    decoder_ = telemetry::LinkDecoder(*definitions_, framing_);
    counted_ = {};
}

/// Messages from the ground to an aircraft are no telemetry.
void LinkReader::forward(const telemetry::LinkMessage& message) {
    if (message.class_id != telemetry::MessageDictionary::telemetry_class)
        return sink_.count("messages of other classes than telemetry", 1);
    sink_.push({message.time_s, std::string(message.text), false, {message.values.begin(), message.values.end()}});
}

void LinkReader::count_unusable() {
    const auto& now = decoder_.counts();
    sink_.count("frames of messages that are not defined", now.unknown - counted_.unknown);
    sink_.count("frames of another length than their message's", now.length_mismatches - counted_.length_mismatches);
    sink_.count("bytes between frames", now.skipped_bytes - counted_.skipped_bytes);
    counted_ = now;
}

}  // namespace flightwatt::live
