#include "live/sources/receiving_source.h"

#include <csignal>

#include <boost/asio/post.hpp>

namespace flightwatt::live {
namespace {

/// A thread that is given no signals: they are for the one that asks for messages.
std::thread start_without_signals(std::function<void()> work) {
    sigset_t all, before;
    ::sigfillset(&all);
    ::pthread_sigmask(SIG_SETMASK, &all, &before);
    std::thread thread(std::move(work));
    ::pthread_sigmask(SIG_SETMASK, &before, nullptr);
    return thread;
}

}  // namespace

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
