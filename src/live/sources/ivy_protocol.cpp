#include "live/sources/ivy_protocol.h"

#include "base/error.h"
#include "base/number.h"
#include "base/text.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <boost/algorithm/string/classification.hpp>
#include <boost/algorithm/string/predicate.hpp>
#include <boost/algorithm/string/trim.hpp>
#include <fmt/format.h>

namespace flightwatt::live {
namespace {

constexpr char arguments_begin = '\002';
constexpr char group_end = '\003';

/// Parses all of `text`, except for blanks around the number, which sscanf in Ivy's C library accepts.
template <typename Number>
std::optional<Number> whole_number(std::string_view text) {
    const auto number = parse_unsigned(boost::algorithm::trim_copy(std::string(text)));
    if (!number || *number > static_cast<std::uint64_t>(std::numeric_limits<Number>::max())) return std::nullopt;
    return static_cast<Number>(*number);
}

constexpr std::string_view replay_prefix = "replay";
constexpr std::string_view time_prefix = "time";
constexpr std::size_t max_waiting_replay = 1000;

bool is_id(std::string_view word) {
    constexpr std::size_t max_digits = 5;
    return !word.empty() && word.size() <= max_digits && boost::algorithm::all(word, boost::algorithm::is_digit());
}

/// Whether a word is a prefix and an aircraft's id, as "replay20".
bool has_id(std::string_view prefix, std::string_view word) {
    return word.starts_with(prefix) && is_id(word.substr(prefix.size()));
}

}  // namespace

boost::asio::ip::udp::endpoint parse_ivy_bus(std::string_view text) {
    constexpr std::uint16_t default_port = 2010;
    const auto colon = text.rfind(':');
    std::string network(text.substr(0, colon));
    const auto port =
        colon == std::string_view::npos ? default_port : whole_number<std::uint16_t>(text.substr(colon + 1));
    if (network.empty()) network = "127";
    while (std::ranges::count(network, '.') < 3) network += ".255";
    boost::system::error_code error;
    const auto address = boost::asio::ip::make_address_v4(network, error);
    if (!error && port.value_or(0) > 0) return {address, *port};
    throw UsageError(fmt::format("Ivy bus '{}': expected ADDRESS:PORT, as 127.255.255.255:2010", text));
}

std::string to_datagram(const IvyAnnouncement& announcement) {
    return fmt::format("{} {} {} {}\n", ivy_version, announcement.port, announcement.id, announcement.name);
}

std::optional<IvyAnnouncement> parse_announcement(std::string_view datagram) {
    auto rest = datagram.substr(0, datagram.find_first_of("\r\n"));
    const auto version = whole_number<int>(take_word(rest, ' '));
    const auto port = whole_number<std::uint16_t>(take_word(rest, ' '));
    if (version != ivy_version || !port || *port == 0) return std::nullopt;
    const auto id = take_word(rest, ' ');
    return IvyAnnouncement{*port, std::string(id), std::string(rest)};
}

std::optional<IvyLine> parse_ivy_line(std::string_view line) {
    const auto begin = line.find(arguments_begin);
    if (begin == std::string_view::npos) return std::nullopt;
    auto head = line.substr(0, begin);
    const auto type = whole_number<int>(take_word(head, ' '));
    const auto id = whole_number<int>(head);
    if (!type || !id) return std::nullopt;
    return IvyLine{*type, *id, line.substr(begin + 1)};
}

std::string to_ivy_line(IvyType type, int id, std::string_view arguments) {
    auto line = fmt::format("{} {}{}{}", static_cast<int>(type), id, arguments_begin, arguments);
    std::replace(line.begin(), line.end(), '\n', ' ');
    return line + '\n';
}

std::vector<std::string_view> split_groups(std::string_view arguments) {
    std::vector<std::string_view> groups;
    while (!arguments.empty()) groups.push_back(take_word(arguments, group_end));
    return groups;
}

void IvyMessages::handle(std::string_view text) {
    text.remove_prefix(std::min(text.find_first_not_of(' '), text.size()));
    const auto blank = text.find(' ');
    if (blank == std::string_view::npos) return sink_.count("messages of a single word", 1);
    const auto sender = text.substr(0, blank);
    if (has_id(time_prefix, sender)) {
        const auto time_s = parse_number(boost::algorithm::trim_copy(std::string(text.substr(blank))));
        if (!time_s || !std::isfinite(*time_s)) return sink_.count("replay times that are not numbers", 1);
        if (!waiting_.empty()) latest_time_s_ = time_s;
        for (auto& message : std::exchange(waiting_, {})) sink_.push({time_s, std::move(message)});
    } else if (!has_id(replay_prefix, sender)) {
        if (is_id(sender)) {
            has_aircraft_ = true;
            waiting_.clear();
        }
        // Messages from the ground during a replay get the replay's time.
        sink_.push({has_aircraft_ ? std::nullopt : latest_time_s_, std::string(text)});
    } else if (has_aircraft_ || waiting_.size() >= max_waiting_replay) {
        sink_.count("messages of a replay without times, or while an aircraft itself is on the bus", 1);
    } else {
        waiting_.emplace_back(text.substr(replay_prefix.size()));
    }
}

}  // namespace flightwatt::live
