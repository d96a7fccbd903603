#include "live/sources/receiving_source.h"

#include <algorithm>
#include <iterator>
#include <utility>

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
        ++report_.unusable["messages that came in faster than they were looked at"];
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

}  // namespace flightwatt::live
