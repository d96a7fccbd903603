#include "live/sources/message_readers.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include <fmt/format.h>

namespace flightwatt::live {

void MessageQueue::push(IncomingMessage message) {
    const std::chrono::duration<double> since = std::chrono::steady_clock::now() - opened_;
    if (!message.time_s) message.time_s = since.count() * clock_factor_;
    const std::lock_guard lock(mutex_);
    message.is_after_restart = std::exchange(restarted_, false);
    waiting_.push_back(std::move(message));
    ++report_.messages;
    if (waiting_.size() > max_waiting) {
        waiting_.pop_front();
        report_.count("messages dropped as they arrived faster than they were processed", 1);
    }
    changed_.notify_one();
}

void MessageQueue::count(std::string_view reason, std::size_t times) {
    const std::lock_guard lock(mutex_);
    report_.count(reason, times);
}

void MessageQueue::count_restart() {
    const std::lock_guard lock(mutex_);
    ++report_.restarts;
    restarted_ = true;
}

void MessageQueue::take(std::chrono::milliseconds timeout, std::vector<IncomingMessage>& messages,
                        SourceReport& report) {
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, timeout, [&] { return !waiting_.empty(); });
    const auto end = waiting_.begin() + static_cast<std::ptrdiff_t>(std::min(waiting_.size(), max_per_call));
    std::move(waiting_.begin(), end, std::back_inserter(messages));
    waiting_.erase(waiting_.begin(), end);
    report = report_;
}

std::size_t LineBuffer::push(std::string_view bytes, std::vector<std::string>& lines) {
    std::size_t overlong = 0;
    while (!bytes.empty()) {
        const auto line_break = bytes.find('\n');
        const auto chunk = bytes.substr(0, line_break);
        if (!dropping_ && partial_.size() + chunk.size() > max_line) {
            dropping_ = true;
            ++overlong;
            partial_.clear();
        }
        if (!dropping_) partial_ += chunk;
        if (line_break == std::string_view::npos) break;
        if (!dropping_) lines.push_back(take_partial_line());
        dropping_ = false;
        bytes.remove_prefix(line_break + 1);
    }
    return overlong;
}

std::string LineBuffer::take_partial_line() {
    auto line = std::exchange(partial_, {});
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
    if (auto message = parse_message_line(line)) return sink_.push(std::move(*message));
    sink_.count("lines that are not messages (TIME SENDER NAME ...)", 1);
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

/// Messages from the ground to an aircraft are not telemetry.
void LinkReader::forward(const telemetry::LinkMessage& message) {
    if (message.class_id != telemetry::MessageDictionary::telemetry_class)
        return sink_.count("messages of other classes than telemetry", 1);
    sink_.push({message.time_s, std::string(message.text), false, {message.values.begin(), message.values.end()}});
}

void LinkReader::count_unusable() {
    const auto& now = decoder_.counts();
    sink_.count("frames of messages that are not defined", now.unknown - counted_.unknown);
    sink_.count("frames whose length differs from their message's", now.length_mismatches - counted_.length_mismatches);
    sink_.count("bytes between frames", now.skipped_bytes - counted_.skipped_bytes);
    counted_ = now;
}

void MavlinkReader::push(std::string_view bytes) {
    decoder_.push(bytes, [this](const telemetry::MavlinkMessageOfVehicle& message) {
        IncomingMessage incoming;
        if (message.unix_s) {
            if (!start_unix_s_) start_unix_s_ = message.unix_s;
            incoming.time_s = *message.unix_s - *start_unix_s_;
            incoming.begin_unix_s = start_unix_s_;
        }
        incoming.text = fmt::format("{} {}", message.sender, message.name);
        incoming.values.assign(message.values.begin(), message.values.end());
        incoming.packet = message.packet;
        sink_.push(std::move(incoming));
    });
    count_unusable();
}

void MavlinkReader::restart() {
    decoder_.restart();
    count_unusable();
}

void MavlinkReader::count_unusable() {
    const auto skipped = decoder_.skipped_bytes();
    sink_.count("bytes between frames", skipped - std::exchange(skipped_bytes_, skipped));
    const auto lost = vehicles_->take_lost();
    sink_.count(vehicles_->alternates() ? "numbers of messages missing: two vehicles have one id, or one is heard twice"
                                        : "messages lost on the link",
                lost);
}

}  // namespace flightwatt::live
