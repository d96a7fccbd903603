#pragma once

#include "live/live_flight.h"
#include "live/sources/message_readers.h"

#include <algorithm>
#include <string_view>
#include <utility>

namespace flightwatt::fuzz {

/// Follows a flight by the messages of a link, of which one arrives every tenth of a second.
class FlightSink final : public live::MessageSink {
  public:
    FlightSink() : flight_(options(), std::nullopt, nullptr) {}
    void push(live::IncomingMessage message) override { flight_.receive(std::move(message), arrival_s_ += 0.1); }
    void count(std::string_view, std::size_t) override {}

    /// Receives the bytes of a link in pieces, and ends the flight.
    template <typename Reader>
    void receive(Reader& reader, std::string_view bytes) {
        constexpr std::size_t piece = 1000;
        for (; !bytes.empty(); bytes.remove_prefix(std::min(piece, bytes.size()))) {
            reader.push(bytes.substr(0, piece));
            flight_.update();
        }
        reader.flush();
        flight_.end();
        flight_.update();
    }

  private:
    static live::LiveOptions options() {
        live::LiveOptions options;
        options.max_rows = 1000;
        return options;
    }

    live::LiveFlight flight_;
    double arrival_s_ = 0.0;
};

}  // namespace flightwatt::fuzz
