#include "live/sources/serial_receiver.h"

#include <chrono>
#include <utility>

#include <boost/asio/buffer.hpp>
#include <fmt/format.h>

namespace flightwatt::live {
namespace {

using boost::system::error_code;

constexpr std::chrono::milliseconds look_for_it_again{250};

}  // namespace

SerialReceiver::SerialReceiver(boost::asio::io_context& context, MessageQueue& queue, SerialLine line,
                               telemetry::MessageDictionary dictionary)
    : queue_(queue), line_(std::move(line)), dictionary_(std::move(dictionary)), port_(context), timer_(context) {
    if (const auto error = open()) refuse_serial_line(line_, error);
}

error_code SerialReceiver::open() {
    const auto error = open_serial_line(line_, port_);
    if (!error) reader_.emplace(dictionary_, std::nullopt, queue_);
    return error;
}

std::string SerialReceiver::description() const { return fmt::format("{} at {} baud", line_.device, line_.baud); }

void SerialReceiver::stop() {
    stopped_ = true;
    error_code ignored;
    timer_.cancel(ignored);
    port_.close(ignored);
}

void SerialReceiver::listen() {
    port_.async_read_some(boost::asio::buffer(received_), [this](const error_code& error, std::size_t bytes) {
        if (stopped_) return;
        reader_->push({received_.data(), bytes});
        if (!error) return listen();
        reader_->flush();
        error_code ignored;
        port_.close(ignored);
        reopen_later();
    });
}

void SerialReceiver::reopen_later() {
    timer_.expires_after(look_for_it_again);
    timer_.async_wait([this](const error_code& error) {
        if (error || stopped_) return;
        if (open()) return reopen_later();
        queue_.count_restart(false);
        listen();
    });
}

}  // namespace flightwatt::live
