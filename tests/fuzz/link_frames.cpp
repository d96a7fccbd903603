// Bytes of a link, in pieces, to the state of the flight in the air.

#include "fuzz/fuzz_target.h"
#include "live/live_flight.h"
#include "live/sources/message_readers.h"

#include <algorithm>
#include <memory>
#include <string>

namespace {

using namespace flightwatt;

class FlightSink final : public live::MessageSink {
  public:
    explicit FlightSink(live::LiveFlight& flight) : flight_(flight) {}
    void push(live::IncomingMessage message) override { flight_.receive(std::move(message), arrival_s_ += 0.1); }
    void count(std::string_view, std::size_t) override {}

  private:
    live::LiveFlight& flight_;
    double arrival_s_ = 0.0;
};

}  // namespace

void flightwatt::fuzz::run(std::string_view bytes) {
    static const std::string definitions = std::string(FLIGHTWATT_SOURCE_DIR) + "/logs/opterra_synthetic_01.log";
    static const auto messages =
        std::make_shared<const telemetry::MessageDictionary>(telemetry::read_message_dictionary(definitions));
    live::LiveOptions options;
    options.max_rows = 1000;
    live::LiveFlight flight(std::move(options), std::nullopt, nullptr);
    FlightSink sink(flight);
    live::LinkReader reader(sink, messages);
    constexpr std::size_t piece = 1000;
    for (; !bytes.empty(); bytes.remove_prefix(std::min(piece, bytes.size()))) {
        reader.push(bytes.substr(0, piece));
        flight.update();
    }
    reader.flush();
    flight.end();
    flight.update();
}
