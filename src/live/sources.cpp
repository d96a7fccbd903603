#include "live/sources.h"

#include "live/sources/ivy_receiver.h"
#include "live/sources/receiving_source.h"

namespace flightwatt::live {

std::unique_ptr<MessageSource> open_ivy_bus(std::string_view bus, double clock_factor) {
    return std::make_unique<ReceivingSource>(clock_factor, [&](auto& context, auto& queue) {
        return std::make_unique<IvyReceiver>(context, queue, parse_ivy_bus(bus));
    });
}

}  // namespace flightwatt::live
