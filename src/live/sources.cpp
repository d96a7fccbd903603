#include "live/sources.h"

#include "base/error.h"
#include "base/number.h"
#include "live/sources/binary_log_source.h"
#include "live/sources/host_and_port.h"
#include "live/sources/ivy_receiver.h"
#include "live/sources/receiving_source.h"
#include "live/sources/serial_receiver.h"
#include "live/sources/udp_receiver.h"

#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>

namespace flightwatt::live {
namespace {

/// "/dev/ttyUSB0:57600"; device names may have colons of their own.
std::pair<std::string, unsigned> parse_serial_line(std::string_view text) {
    constexpr unsigned usual_baud = 57'600;  // of Paparazzi's modems
    constexpr unsigned fastest_baud = 4'000'000;
    const auto colon = text.rfind(':');
    const auto baud = colon == std::string_view::npos ? std::nullopt : parse_unsigned(text.substr(colon + 1));
    if (!baud) return {std::string(text), usual_baud};
    if (colon == 0 || *baud == 0 || *baud > fastest_baud) {
        throw UsageError(fmt::format("serial line '{}': expected DEVICE:BAUD, as /dev/ttyUSB0:57600", text));
    }
    return {std::string(text.substr(0, colon)), static_cast<unsigned>(*baud)};
}

}  // namespace

std::unique_ptr<MessageSource> open_ivy_bus(std::string_view bus, double clock_factor) {
    return std::make_unique<ReceivingSource>(clock_factor, [&](auto& context, auto& queue) {
        return std::make_unique<IvyReceiver>(context, queue, parse_ivy_bus(bus));
    });
}

std::unique_ptr<MessageSource> open_udp(std::string_view at, telemetry::MessageDictionary definitions,
                                        double clock_factor) {
    return std::make_unique<ReceivingSource>(clock_factor, [&](auto& context, auto& queue) {
        return std::make_unique<UdpReceiver>(context, queue, parse_udp_address(at), std::move(definitions));
    });
}

std::unique_ptr<MessageSource> open_serial(std::string_view line, telemetry::MessageDictionary definitions,
                                           double clock_factor) {
    return std::make_unique<ReceivingSource>(clock_factor, [&](auto& context, auto& queue) {
        auto [device, baud] = parse_serial_line(line);
        return std::make_unique<SerialReceiver>(context, queue, std::move(device), baud, std::move(definitions));
    });
}

std::unique_ptr<MessageSource> follow_binary_log(const std::filesystem::path& path,
                                                 telemetry::MessageDictionary definitions) {
    return std::make_unique<BinaryLogSource>(path, std::move(definitions));
}

}  // namespace flightwatt::live
