#include "live/sources/serial_receiver.h"

#include "base/error.h"
#include "live/sources/close_on_exec.h"

#include <chrono>
#include <utility>

#include <boost/asio/buffer.hpp>
#include <fmt/format.h>

namespace flightwatt::live {
namespace {

using Port = boost::asio::serial_port;
using boost::system::error_code;

constexpr std::chrono::milliseconds look_for_it_again{250};

/// The system's raw mode, and this speed.
void set_up(Port& port, unsigned baud, error_code& error) {
    port.set_option(Port::baud_rate(baud), error);
    if (!error) port.set_option(Port::character_size(8), error);
    if (!error) port.set_option(Port::parity(Port::parity::none), error);
    if (!error) port.set_option(Port::stop_bits(Port::stop_bits::one), error);
    if (!error) port.set_option(Port::flow_control(Port::flow_control::none), error);
}

}  // namespace

SerialReceiver::SerialReceiver(boost::asio::io_context& context, MessageQueue& queue, std::string device, unsigned baud,
                               telemetry::MessageDictionary dictionary)
    : queue_(queue),
      device_(std::move(device)),
      baud_(baud),
      dictionary_(std::move(dictionary)),
      port_(context),
      timer_(context) {
    const auto error = open();
    if (error) {
        throw InputError({device_},
                         fmt::format("cannot open it as a serial line of {} baud: {}", baud_, error.message()),
                         "see that it is plugged in, may be read (group dialout), and knows the speed");
    }
}

error_code SerialReceiver::open() {
    error_code error;
    port_.open(device_, error);
    if (!error) set_up(port_, baud_, error);
    if (error) {
        error_code ignored;
        port_.close(ignored);
        return error;
    }
    close_on_exec(port_);
    reader_.emplace(dictionary_, std::nullopt, queue_);
    return error;
}

std::string SerialReceiver::description() const { return fmt::format("{} at {} baud", device_, baud_); }

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
