#include "live/sources/ivy_protocol.h"

#include "base/error.h"

#include <algorithm>
#include <charconv>
#include <limits>

#include <fmt/format.h>

namespace flightwatt::live {
namespace {

constexpr char arguments_begin = '\002';
constexpr char group_end = '\003';
constexpr std::string_view default_network = "127.255.255.255";

/// The number that all of `text` is; blanks around it are let pass, as by sscanf in Ivy's C library.
template <typename Number>
std::optional<Number> whole_number(std::string_view text) {
    while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
    while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
    Number number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
    return number;
}

/// What stands before the next `mark`, which is taken off with it.
std::string_view take_until(std::string_view& text, char mark) {
    const auto end = std::min(text.find(mark), text.size());
    const auto part = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    return part;
}

[[noreturn]] void refuse_bus(std::string_view text, std::string_view why) {
    throw UsageError(fmt::format("Ivy bus '{}': {}; expected ADDRESS:PORT, as 127.255.255.255:2010", text, why));
}

/// "127" becomes "127.255.255.255".
std::string parse_network(std::string_view text, std::string_view bus) {
    std::string network;
    int parts = 0;
    for (auto rest = text; !rest.empty(); ++parts) {
        const auto part = take_until(rest, '.');
        const auto number = whole_number<unsigned>(part);
        if (!number || *number > std::numeric_limits<std::uint8_t>::max() || parts == 4)
            refuse_bus(bus, fmt::format("'{}' is no address", text));
        network += fmt::format("{}{}", parts == 0 ? "" : ".", *number);
    }
    for (; parts < 4; ++parts) network += ".255";
    return network;
}

}  // namespace

bool IvyBus::is_local() const {
    return std::all_of(networks.begin(), networks.end(),
                       [](const auto& network) { return network.starts_with("127."); });
}

IvyBus parse_ivy_bus(std::string_view text) {
    IvyBus bus;
    auto networks = text;
    if (const auto colon = text.rfind(':'); colon != std::string_view::npos) {
        const auto port = whole_number<std::uint16_t>(text.substr(colon + 1));
        if (!port || *port == 0) refuse_bus(text, fmt::format("'{}' is no port", text.substr(colon + 1)));
        bus.port = *port;
        networks = text.substr(0, colon);
    }
    if (networks.empty()) networks = default_network;
    while (!networks.empty()) {
        const auto network = take_until(networks, ',');
        if (network.empty()) refuse_bus(text, "an address is empty");
        bus.networks.push_back(parse_network(network, text));
    }
    return bus;
}

std::string to_datagram(const IvyAnnouncement& announcement) {
    return fmt::format("{} {} {} {}\n", ivy_version, announcement.port, announcement.id, announcement.name);
}

std::optional<IvyAnnouncement> parse_announcement(std::string_view datagram) {
    auto rest = datagram.substr(0, datagram.find_first_of("\r\n"));
    const auto version = whole_number<int>(take_until(rest, ' '));
    const auto port = whole_number<std::uint16_t>(take_until(rest, ' '));
    if (version != ivy_version || !port || *port == 0) return std::nullopt;
    const auto id = take_until(rest, ' ');
    return IvyAnnouncement{*port, std::string(id), std::string(rest)};
}

std::optional<IvyLine> parse_ivy_line(std::string_view line) {
    const auto begin = line.find(arguments_begin);
    if (begin == std::string_view::npos) return std::nullopt;
    auto head = line.substr(0, begin);
    const auto type = whole_number<int>(take_until(head, ' '));
    const auto id = whole_number<int>(head);
    if (!type || !id) return std::nullopt;
    return IvyLine{*type, *id, line.substr(begin + 1)};
}

std::string to_ivy_line(IvyType type, int id, std::string_view arguments) {
    auto line = fmt::format("{} {}{}{}", static_cast<int>(type), id, arguments_begin, arguments);
    std::replace(line.begin(), line.end(), '\n', ' ');
    return line + '\n';
}

std::vector<std::string_view> groups_of(std::string_view arguments) {
    std::vector<std::string_view> groups;
    while (!arguments.empty()) groups.push_back(take_until(arguments, group_end));
    return groups;
}

}  // namespace flightwatt::live
