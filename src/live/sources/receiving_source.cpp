#include "live/sources/receiving_source.h"

#include "live/sources/signal_free_thread.h"

#include <boost/asio/post.hpp>

namespace flightwatt::live {
ReceivingSource::ReceivingSource(double clock_factor, const MakeReceiver& make)
    : queue_(clock_factor), receiver_(make(context_, queue_)), description_(receiver_->description()) {
    boost::asio::post(context_, [this] { receiver_->start(); });
    thread_ = start_without_signals([this] { context_.run(); });
}

ReceivingSource::~ReceivingSource() {
    boost::asio::post(context_, [this] { receiver_->stop(); });
    thread_.join();
}

void ReceivingSource::receive(std::chrono::milliseconds timeout, std::vector<IncomingMessage>& messages) {
    queue_.take(timeout, messages, report_);
}

}  // namespace flightwatt::live
