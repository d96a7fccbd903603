#include "live/sources.h"

#include "live/sources/binary_log_source.h"
#include "live/sources/host_and_port.h"
#include "live/sources/ivy_receiver.h"
#include "live/sources/receiving_source.h"
#include "live/sources/serial_line.h"
#include "live/sources/serial_receiver.h"
#include "live/sources/udp_receiver.h"

#include <utility>

namespace flightwatt::live {
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
        return std::make_unique<SerialReceiver>(context, queue, parse_serial_line(line), std::move(definitions));
    });
}

std::unique_ptr<MessageSource> follow_binary_log(const std::filesystem::path& path,
                                                 telemetry::MessageDictionary definitions) {
    return std::make_unique<BinaryLogSource>(path, std::move(definitions));
}

}  // namespace flightwatt::live
