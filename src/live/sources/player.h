#pragma once

#include "live/playback.h"
#include "live/sources/message_readers.h"

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <functional>
#include <optional>
#include <string_view>

namespace flightwatt::live {

/// Sends the messages of a log to a target when they are due.
class Player final : public MessageSink {
  public:
    Player(double speed, const PlaybackTarget& target, const std::function<bool()>& stop)
        : speed_(speed), target_(target), stop_(stop) {}

    bool is_stopped() const { return report_.stopped; }
    void push(IncomingMessage message) override;
    void count(std::string_view reason, std::size_t times) override;
    /// Returns what was played.
    PlaybackReport end();

  private:
    double speed_;
    const PlaybackTarget& target_;
    const std::function<bool()>& stop_;
    PlaybackReport report_;
    std::optional<double> last_s_;  ///< of the message before, on the log's clock
    std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

/// Passes bytes to a reader in chunks, so that a stopped player ends soon.
template <typename Reader>
void play_bytes(std::string_view bytes, Reader& reader, const Player& player) {
    constexpr std::size_t chunk = 4096;
    for (auto rest = bytes; !rest.empty() && !player.is_stopped(); rest.remove_prefix(std::min(chunk, rest.size())))
        reader.push(rest.substr(0, chunk));
    if (!player.is_stopped()) reader.flush();
}

}  // namespace flightwatt::live
