#include "live/sources/udp_receiver.h"

#include "base/error.h"
#include "live/sources/close_on_exec.h"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <string_view>

#include <boost/asio/buffer.hpp>
#include <fmt/format.h>

namespace flightwatt::live {
namespace {

constexpr std::size_t max_senders = 16;
constexpr int receive_buffer_bytes = 1 << 20;

}  // namespace

UdpReceiver::UdpReceiver(boost::asio::io_context& context, MessageQueue& queue, const Endpoint& at,
                         telemetry::MessageDictionary dictionary)
    : queue_(queue), dictionary_(std::move(dictionary)), socket_(context) {
    boost::system::error_code error, ignored;
    socket_.open(at.protocol(), error);
    if (!error) socket_.bind(at, error);
    if (error) {
        throw InputError({fmt::format("UDP {}:{}", at.address().to_string(), at.port())},
                         fmt::format("cannot listen: {}", error.message()),
                         "see which program has the port (ss -lup), or take another one");
    }
    close_on_exec(socket_);
    socket_.set_option(boost::asio::socket_base::receive_buffer_size(receive_buffer_bytes), ignored);
}

std::string UdpReceiver::description() const {
    const auto at = socket_.local_endpoint();
    if (at.address().is_unspecified()) return fmt::format("UDP port {}", at.port());
    return fmt::format("UDP {}:{}", at.address().to_string(), at.port());
}

void UdpReceiver::stop() {
    boost::system::error_code ignored;
    socket_.close(ignored);
}

void UdpReceiver::listen() {
    socket_.async_receive_from(boost::asio::buffer(datagram_), from_,
                               [this](const boost::system::error_code& error, std::size_t bytes) {
                                   if (!socket_.is_open()) return;
                                   if (!error) reader_of(from_).push({datagram_.data(), bytes});
                                   listen();
                               });
}

LinkReader& UdpReceiver::reader_of(const Endpoint& sender) {
    const auto known =
        std::find_if(readers_.begin(), readers_.end(), [&](const auto& of) { return of.first == sender; });
    if (known != readers_.end()) {
        readers_.splice(readers_.begin(), readers_, known);
        return readers_.front().second;
    }
    if (readers_.size() == max_senders) readers_.pop_back();
    return readers_.emplace_front(sender, LinkReader(dictionary_, telemetry::Framing::link, queue_)).second;
}

}  // namespace flightwatt::live
