#include "telemetry/mavlink/tlog.h"

#include "base/error.h"
#include "base/units.h"
#include "telemetry/binary/wire_value.h"
#include "telemetry/mavlink/entries.h"
#include "telemetry/mavlink/station_clock.h"
#include "telemetry/mavlink/vehicles.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace flightwatt::telemetry {
namespace {

using Entry = TlogEntry;
using SenderMessage = std::pair<std::pair<int, int>, std::uint32_t>;  ///< system and component, id of the message

constexpr double us_per_s = 1e6;

/// Calls on_entry(Entry, offset) for each packet, and on_skip(offset, bytes) for damage between them.
template <typename OnEntry, typename OnSkip>
void for_each_entry(std::string_view bytes, const OnEntry& on_entry, const OnSkip& on_skip) {
    std::size_t damage = 0;
    for (std::size_t at = 0; at < bytes.size();) {
        const auto entry = read_tlog_entry(bytes.substr(at));
        if (!entry) {
            ++damage;
            ++at;
            continue;
        }
        if (damage > 0) on_skip(at - damage, damage);
        damage = 0;
        on_entry(*entry, at);
        at += tlog_time_bytes + entry->frame.bytes;
    }
    if (damage > 0) on_skip(bytes.size() - damage, damage);
}

/// Whether a message states the autopilot's time since its boot.
bool has_boot_time(const MavlinkFrame& frame) {
    if (frame.message == nullptr) return false;
    const auto& name = frame.message->layout.name;
    return name == "SYSTEM_TIME" || name == "GLOBAL_POSITION_INT" || name == "ATTITUDE";
}

/// Whether the times of a message since the boot run ahead of those of reception in most steps, as the microseconds that
/// INAV and Betaflight state as milliseconds.
bool is_ahead(const std::vector<BootTime>& times) {
    constexpr double max_speed = 10.0;
    constexpr double max_ahead_s = 5.0;
    constexpr std::size_t enough_times = 10;
    std::size_t ahead = 0;
    for (std::size_t i = 1; i < times.size(); ++i) {
        const double step_s = std::abs(times[i].boot_s - times[i - 1].boot_s);  // it overflows, too
        ahead += step_s > max_speed * std::abs(times[i].received_s - times[i - 1].received_s) + max_ahead_s ? 1 : 0;
    }
    return times.size() >= enough_times && 2 * ahead > times.size();
}

double boot_time_s(const MavlinkFrame& frame) { return frame.number("time_boot_ms") * units::milli; }

/// The time of reception, from that of the first packet on.
double received_s(const Entry& entry, std::uint64_t start_us) {
    return static_cast<double>(static_cast<std::int64_t>(entry.time_us - start_us)) / us_per_s;
}

/// The number of the board; 0 is unknown.
std::uint64_t uid_of(const MavlinkFrame& version) {
    return wire_number<std::uint64_t>(version.payload.data() + sizeof(std::uint64_t));
}

/// The component that flies each system. Without its heartbeat it is the first one that states a position or a battery.
struct Census {
    std::map<int, Autopilot> autopilots;
    std::map<int, Autopilot> others;
    std::set<int> px4 = {};                                                  ///< systems
    std::map<std::pair<int, int>, std::vector<BootTime>> boot_times = {};    ///< by system and component
    std::map<std::pair<int, int>, std::vector<VehicleChange>> changes = {};  ///< likewise
    std::set<SenderMessage> without_boot_time = {};
    std::uint64_t start_us = 0;

    void add(const Entry& entry, std::size_t offset) {
        const auto& frame = entry.frame;
        if (start_us == 0) start_us = entry.time_us;
        if (frame.message == nullptr) return;
        if (has_boot_time(frame))
            times_[{{frame.system, frame.component}, frame.id}].push_back(
                {offset, received_s(entry, start_us), boot_time_s(frame)});
        const auto& name = frame.message->layout.name;
        if (name == "HEARTBEAT" && is_autopilot(frame)) {
            add_autopilot(frame, autopilots);
            if (frame.number("autopilot") == autopilot_px4) px4.insert(frame.system);
            note_vehicle(frame, static_cast<std::uint64_t>(frame.number("type")), offset);
        } else if (name == "AUTOPILOT_VERSION") {
            note_vehicle(frame, uid_of(frame), offset);
        } else if (name == "SYS_STATUS" || name == "GLOBAL_POSITION_INT") {
            others.try_emplace(frame.system, Autopilot{frame.component});
        }
    }

    /// Collects the boot times of each sender, without messages that have another unit.
    void sort_boot_times() {
        for (const auto& [message, times] : times_) {
            if (is_ahead(times)) {
                without_boot_time.insert(message);
                continue;
            }
            auto& all = boot_times[message.first];
            all.insert(all.end(), times.begin(), times.end());
            std::ranges::sort(all, {}, &BootTime::place);
        }
        times_.clear();
    }

  private:
    static constexpr double autopilot_px4 = 12.0;

    /// The number of a vehicle's kind or board; 0 is unknown.
    void note_vehicle(const MavlinkFrame& frame, std::uint64_t number, std::size_t offset) {
        if (number == 0) return;
        const std::pair sender{static_cast<int>(frame.system), static_cast<int>(frame.component)};
        const auto [known, is_first] = stated_.try_emplace({sender, frame.id}, number, offset);
        auto& [last, place] = known->second;
        if (last != number) changes[sender].push_back({place, offset});
        last = number;
        place = offset;
    }

    /// By sender and message: the number, and its latest place.
    std::map<SenderMessage, std::pair<std::uint64_t, std::size_t>> stated_ = {};
    std::map<SenderMessage, std::vector<BootTime>> times_ = {};
};

/// Places of a recording, [begin, end).
struct Places {
    std::size_t begin;
    std::size_t end;
    bool has(std::size_t place) const { return place >= begin && place < end; }
};

/// Collects the messages of one vehicle.
class Vehicle {
  public:
    Vehicle(int system, int component, Places places, const Census& census, const std::filesystem::path& file,
            const std::vector<MessageRequest>& wanted)
        : system_(system),
          component_(component),
          places_(places),
          is_px4_(census.px4.contains(system)),
          without_boot_time_(census.without_boot_time),
          start_us_(census.start_us),
          rows_(file, wanted) {
        if (const auto times = census.boot_times.find({system, component}); times != census.boot_times.end())
            clock_steps_ = find_clock_steps(times->second);
        double start_s = static_cast<double>(start_us_) / us_per_s;
        for (const auto& step : clock_steps_) start_s += step.step_s;  // a clock that was set is right
        rows_.facts().information["start_unix_s"] = fmt::format("{:.6f}", start_s);
    }

    void add(const Entry& entry, std::size_t offset) {
        const auto& frame = entry.frame;
        if (frame.system != system_ || !places_.has(offset)) return;
        if (!is_of_vehicle(frame, component_) || !sequence_.add(frame)) return;
        auto& layout = layout_of(frame);
        ++layout.count;
        if (frame.message == nullptr) return;
        const double time_s = time_of(entry, offset);
        add_facts(frame, time_s);
        rows_.add(layout, time_s, offset, [&](std::size_t field) { return value_of(frame, field); });
    }

    void skip(std::size_t offset, std::size_t bytes) {
        if (places_.has(offset)) rows_.skip(offset, bytes);
    }

    AutopilotLog take() {
        for (const auto& [id, layout] : layouts_) rows_.list(layout);
        if (sequence_.alternates()) {
            rows_.facts().notes.push_back(
                fmt::format("the numbers of the messages of system {} alternate: two vehicles have this id, or one was "
                            "heard twice; give each its own (SYSID_THISMAV, MAV_SYS_ID)",
                            system_));
        } else if (sequence_.lost() > 0) {
            const auto all = static_cast<double>(sequence_.lost() + sequence_.received());
            rows_.facts().notes.push_back(
                fmt::format("{:.1f} % of the messages of system {} were lost on the link",
                            units::percent_per_whole * static_cast<double>(sequence_.lost()) / all, system_));
        }
        auto log = rows_.take(false);
        log.log.senders.front().id = fmt::format("{}", system_);
        return log;
    }

  private:
    /// The time of reception by the clock as it was at first.
    double time_of(const Entry& entry, std::size_t offset) {
        constexpr std::size_t max_notes = 10;
        const double time_s = received_s(entry, start_us_);
        for (; passed_ < clock_steps_.size() && clock_steps_[passed_].has_passed(offset, time_s); ++passed_) {
            const auto& step = clock_steps_[passed_];
            if (passed_ < max_notes)
                rows_.facts().notes.push_back(fmt::format(
                    "the clock of the computer that recorded is set {} by {:.1f} s at {:.1f} s, as the autopilot's "
                    "shows: later times are corrected",
                    step.step_s > 0.0 ? "forward" : "back", std::abs(step.step_s), step.before.received_s - ahead_s_));
            ahead_s_ += step.step_s;
        }
        return time_s - ahead_s_;
    }

    LoggedMessage& layout_of(const MavlinkFrame& frame) {
        const auto [found, is_new] = layouts_.try_emplace(frame.id);
        if (!is_new) return found->second;
        if (frame.message == nullptr) {
            found->second.name = fmt::format("MESSAGE_{}", frame.id);
        } else {
            found->second = frame.message->layout;
            rows_.bind(found->second);
        }
        return found->second;
    }

    void add_facts(const MavlinkFrame& frame, double time_s) {
        const auto& name = frame.message->layout.name;
        if (name == "PARAM_VALUE") add_parameter(frame);
        if (name == "STATUSTEXT") add_text(frame);
        if (name == "AUTOPILOT_VERSION") add_version(frame);
        if (has_boot_time(frame) && !without_boot_time_.contains({{system_, frame.component}, frame.id}))
            note_restart(boot_time_s(frame), time_s);
    }

    /// PX4 sends the bytes of a whole number in place of a float, others its value.
    void add_parameter(const MavlinkFrame& frame) {
        constexpr double last_whole_type = 6.0;  // int32
        double value = frame.number("param_value");
        if (is_px4_ && frame.number("param_type") <= last_whole_type)
            value = wire_number<std::int32_t>(frame.payload.data());
        if (!std::isnan(value)) rows_.facts().parameters[frame.text("param_id")] = value;
    }

    /// A long text comes in parts of 50 bytes with a common id.
    void add_text(const MavlinkFrame& frame) {
        constexpr std::size_t max_texts = 1000;
        auto& texts = rows_.facts().texts;
        const double id = frame.number("id");
        if (id > 0.0 && frame.number("chunk_seq") > 0.0 && id == text_id_ && !texts.empty())
            texts.back() += frame.text("text");
        else if (texts.size() < max_texts)
            texts.push_back(frame.text("text"));
        text_id_ = id;
    }

    void add_version(const MavlinkFrame& frame) {
        const auto uid = uid_of(frame);
        if (uid != 0) rows_.facts().information["uid"] = fmt::format("{:016X}", uid);
    }

    void note_restart(double boot_s, double time_s) {
        constexpr double restart_s = 2.0;  // a late packet is not
        if (boot_s < boot_s_ - restart_s && rows_.facts().notes.size() < 10)
            rows_.facts().notes.push_back(fmt::format("the autopilot restarted at {:.1f} s", time_s));
        boot_s_ = boot_s;
    }

    int system_;
    int component_;
    Places places_;
    bool is_px4_;
    std::set<SenderMessage> without_boot_time_;
    std::uint64_t start_us_;
    RowCollector rows_;
    MavlinkSequence sequence_;
    std::map<std::uint32_t, LoggedMessage> layouts_;
    std::vector<ClockStep> clock_steps_;
    std::size_t passed_ = 0;  ///< steps
    double ahead_s_ = 0.0;    ///< by these
    double boot_s_ = 0.0;
    double text_id_ = 0.0;
};

/// The vehicles of a log; those without a heartbeat only if no system has one. Of one system several may follow each
/// other.
std::vector<Vehicle> vehicles_of(const Census& census, const std::filesystem::path& file,
                                 const std::vector<MessageRequest>& wanted) {
    std::vector<Vehicle> vehicles;
    for (const auto& [system, autopilot] : census.autopilots.empty() ? census.others : census.autopilots) {
        std::size_t begin = 0;
        const auto add_until = [&, system = system, component = autopilot.component](std::size_t end) {
            vehicles.emplace_back(system, component, Places{begin, end}, census, file, wanted);
            begin = end;
        };
        const std::pair sender{system, autopilot.component};
        const auto changes = census.changes.find(sender);
        const auto times = census.boot_times.find(sender);
        if (changes != census.changes.end() && times != census.boot_times.end())
            std::ranges::for_each(find_other_vehicles(changes->second, times->second), add_until);
        add_until(std::numeric_limits<std::size_t>::max());
    }
    return vehicles;
}

/// Whether the bytes begin with two packets behind as many bytes each, the first with a checksum that fits.
bool begins_with_packets(std::string_view bytes, std::size_t behind) {
    if (bytes.size() < behind) return false;
    const auto first = read_mavlink_frame(bytes.substr(behind));
    if (!first || first->message == nullptr) return false;
    const auto second = 2 * behind + first->bytes;
    return bytes.size() > second && mavlink_frame_bytes(bytes.substr(second)) != 0;
}

}  // namespace

bool is_tlog(std::string_view bytes) {
    constexpr std::size_t max_damage = 1024;
    for (std::size_t at = 0; at < std::min(bytes.size(), max_damage); ++at) {
        const auto entry = read_tlog_entry(bytes.substr(at));
        if (entry && (entry->frame.message != nullptr || at == 0)) return true;
    }
    return begins_with_packets(bytes, tlog_time_bytes) || begins_with_packets(bytes, 0);  // read_tlog() refuses them
}

std::vector<AutopilotLog> read_tlog(std::string_view bytes, const std::filesystem::path& file,
                                    const std::vector<MessageRequest>& wanted) {
    Census census;
    for_each_entry(
        bytes, [&](const Entry& entry, std::size_t offset) { census.add(entry, offset); },
        [](std::size_t, std::size_t) {});
    census.sort_boot_times();
    auto vehicles = vehicles_of(census, file, wanted);
    if (begins_with_packets(bytes, 0)) {
        throw InputError({file.string()}, "has MAVLink without times of reception",
                         "read the .tlog instead: MAVProxy writes it next to its .tlog.raw");
    }
    if (census.start_us == 0) {
        throw InputError({file.string()}, "has MAVLink, but no times between 2001 and 2100",
                         "the clock of the computer that recorded it was not set: read the autopilot's own log");
    }
    if (vehicles.empty()) {
        throw InputError({file.string()}, "has MAVLink, but no messages of a vehicle",
                         "expected heartbeats of an autopilot: was the recording made while it was connected?");
    }
    for_each_entry(
        bytes,
        [&](const Entry& entry, std::size_t offset) {
            for (auto& vehicle : vehicles) vehicle.add(entry, offset);
        },
        [&](std::size_t offset, std::size_t skipped) {
            for (auto& vehicle : vehicles) vehicle.skip(offset, skipped);
        });
    std::vector<AutopilotLog> logs;
    logs.reserve(vehicles.size());
    for (auto& vehicle : vehicles) logs.push_back(vehicle.take());
    return logs;
}

}  // namespace flightwatt::telemetry
