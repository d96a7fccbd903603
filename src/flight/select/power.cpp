#include "flight/select/power.h"

#include "base/statistics.h"
#include "flight/families/derived_tracks.h"
#include "flight/select/device_check.h"
#include "flight/select/device_sum.h"
#include "flight/select/outliers.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include <fmt/format.h>

namespace flightwatt::flight {
namespace {

constexpr double compared_w = 1.0;
constexpr std::size_t enough_pairs = 10;

/// The first candidate of that name that `accept` takes, or nullptr.
template <typename Accept>
const Track* find_track(const FlightSeries& series, std::string_view name, const Accept& accept) {
    const auto found =
        std::ranges::find_if(series.tracks, [&](const Track& track) { return track.name == name && accept(track); });
    return found == series.tracks.end() ? nullptr : &*found;
}

/// Voltage times current of one message; nullptr if it lacks one of them.
const Track* find_product(const FlightSeries& series, std::string_view message) {
    return find_track(series, "power_w", [&](const Track& track) {
        return track.source.starts_with(message) && track.source.find(" * ") != std::string::npos &&
               track.device.empty();
    });
}

/// One of the batteries that a log numbers, without a current.
bool is_unmeasured_battery(const Track& power) {
    return power.empty() && !power.device.empty() && power.source.find(" * ") != std::string::npos;
}

/// A track without a message: of a user's CSV.
const Track* find_plain(const FlightSeries& series, std::string_view name) {
    return find_track(series, name, [](const Track& track) {
        return track.device.empty() && track.source.find('.') == std::string::npos;
    });
}

/// Power, and voltage times current, at one time.
struct PowerPair {
    double time_s;
    double power_w;
    double product_w;

    double apart_w() const { return std::abs(power_w - product_w); }
    double larger_w() const { return std::max(std::abs(power_w), std::abs(product_w)); }
};

std::vector<PowerPair> pairs_of(const Track& power, const Track& product) {
    std::vector<PowerPair> pairs;
    pairs.reserve(std::min(power.time_s.size(), product.time_s.size()));
    for (std::size_t i = 0, j = 0; i < power.time_s.size(); ++i) {
        while (j < product.time_s.size() && product.time_s[j] < power.time_s[i]) ++j;
        if (j == product.time_s.size()) break;
        if (product.time_s[j] == power.time_s[i]) pairs.push_back({power.time_s[i], power.value[i], product.value[j]});
    }
    return pairs;
}

/// Whether most samples differ from voltage times current: the message has another layout than assumed.
bool contradicts(const Track& power, const Track& product) {
    auto pairs = pairs_of(power, product);
    std::erase_if(pairs, [](const PowerPair& pair) { return std::abs(pair.product_w) <= compared_w; });
    const auto apart = std::ranges::count_if(
        pairs, [](const PowerPair& pair) { return pair.apart_w() > 0.2 * std::abs(pair.product_w); });
    return pairs.size() >= enough_pairs && 2 * apart > std::ssize(pairs);
}

/// The times, rising, at which power differs from voltage times current although it usually does not: by more than 10 %
/// (or ten times the median difference) and 1 W.
std::vector<double> inconsistent_times(const Track& power, const Track& product) {
    constexpr double contradicting_part = 0.10;
    const auto pairs = pairs_of(power, product);
    std::vector<double> parts;
    parts.reserve(pairs.size());
    for (const auto& pair : pairs)
        if (pair.larger_w() > compared_w) parts.push_back(pair.apart_w() / pair.larger_w());
    if (parts.size() < enough_pairs) return {};
    const double part = std::max(contradicting_part, 10.0 * median_high(std::move(parts)));
    std::vector<double> times_s;
    for (const auto& pair : pairs)
        if (pair.apart_w() > part * pair.larger_w() + compared_w) times_s.push_back(pair.time_s);
    return times_s;
}

/// Voltage times current of a user's CSV.
Track plain_product(const FlightSeries& series) {
    Track product;
    const auto* voltage = find_plain(series, "voltage_v");
    const auto* current = find_plain(series, "current_a");
    if (voltage == nullptr || current == nullptr || voltage->time_s != current->time_s) return product;
    product.time_s = voltage->time_s;
    for (std::size_t i = 0; i < voltage->value.size(); ++i)
        product.value.push_back(voltage->value[i] * current->value[i]);
    return product;
}

bool measures_something(const Track& power) {
    return power.time_s.size() >= 2 &&
           std::any_of(power.value.begin(), power.value.end(), [](double value) { return value != 0.0; });
}

/// Chooses a candidate if it measures something, or notes why not.
bool take(const FlightSeries& series, const Track& candidate, ChosenTrack& power,
          const std::vector<double>& contradicted_s = {}) {
    auto cleaned = remove_outliers(candidate, contradicted_s, dropout_throttle(series, candidate));
    if (measures_something(cleaned)) {
        cleaned.not_chosen = std::move(power.not_chosen);
        power = std::move(cleaned);
        return true;
    }
    if (cleaned.empty() && !cleaned.notes.empty()) {
        power.not_chosen.push_back(std::move(cleaned.notes.front()));
    } else {
        power.not_chosen.push_back(candidate.source + (is_unmeasured_battery(candidate)
                                                           ? " has no value: there is no current sensor"
                                                       : candidate.time_s.size() < 2 ? " has no two finite values"
                                                                                     : " is 0 throughout"));
    }
    return false;
}

/// Chooses the sum of the devices that send `message`, or notes why not.
bool take_devices(const FlightSeries& series, std::string_view message, ChosenTrack& power) {
    auto devices = devices_of(series, "power_w", message);
    const auto count = static_cast<double>(devices.size());
    auto sum = sum_over_devices(std::move(devices));
    if (!sum.ambiguity.empty()) power.not_chosen.push_back(std::move(sum.ambiguity));
    if (sum.track.source.empty()) return false;
    if (message == "ESC" && series.motors && count < *series.motors) {
        power.not_chosen.push_back(
            fmt::format("the telemetry of ESCs has the current of {} of {} motors: without the "
                        "others their sum is too small",
                        count, *series.motors));
        return false;
    }
    if (!take(series, sum.track, power)) return false;
    std::ranges::move(sum.notes, std::back_inserter(power.notes));
    std::ranges::move(find_suspect_devices(series, message), std::back_inserter(power.notes));
    return true;
}

}  // namespace

ChosenTrack select_esc_power(const FlightSeries& series) {
    ChosenTrack power;
    take_devices(series, "ESC", power);
    return power;
}

bool has_plain_power(const FlightSeries& series) { return find_plain(series, "power_w") != nullptr; }

std::vector<double> contradicted_times(const FlightSeries& series, std::string_view source) {
    if (source.find('.') == std::string_view::npos) {
        const auto* power = find_plain(series, "power_w");
        return power == nullptr ? std::vector<double>{} : inconsistent_times(*power, plain_product(series));
    }
    const auto* power =
        find_track(series, "power_w", [](const Track& track) { return track.source == "ENERGY.power"; });
    const auto* product = find_product(series, "ENERGY.");
    if (power == nullptr || product == nullptr || !source.starts_with("ENERGY.")) return {};
    return inconsistent_times(*power, *product);
}

Track dropout_throttle(const FlightSeries& series, const Track& candidate) {
    if (std::ranges::find(candidate.value, 0.0) == candidate.value.end()) return {};
    const auto* throttle = find_track(series, "throttle_percent", [](const Track& track) {
        return track.device.empty() && track.source != commanded_throttle && !is_constant(track);
    });
    return throttle == nullptr ? Track{} : within_bounds(*throttle);
}

ChosenTrack select_power(const FlightSeries& series) {
    if (const auto* plain = find_plain(series, "power_w")) {
        // Accepted even if it is 0 throughout.
        auto power =
            remove_outliers(*plain, contradicted_times(series, plain->source), dropout_throttle(series, *plain));
        if (plain->empty() && plain->source.find(" * ") != std::string::npos)
            power.not_chosen.push_back(
                fmt::format("no row has both factors of {}: write them into the same rows", plain->source));
        return power;
    }
    ChosenTrack power;
    const auto* product = find_product(series, "ENERGY.");
    for (const auto& track : series.tracks) {
        if (track.name != "power_w" || !(track.device.empty() || is_unmeasured_battery(track))) continue;
        const bool is_power = track.source == "ENERGY.power";
        if (is_power && product != nullptr && contradicts(track, *product))
            power.not_chosen.emplace_back("ENERGY.power is not voltage times current");
        else if (take(series, track, power,
                      is_power ? contradicted_times(series, track.source) : std::vector<double>{}))
            return power;
    }
    const auto is_bat = [](const Track& track) { return track.source.starts_with("BAT."); };
    if (find_product(series, "BAT.") == nullptr && std::ranges::any_of(series.tracks, is_bat))
        power.not_chosen.emplace_back("BAT has no current");
    for (const auto* message : device_messages)
        if (take_devices(series, message, power)) return power;
    for (const auto* message : {"ENERGY", "ESC", "POWER_DEVICE"}) {
        const auto is_of = [&](const Track& track) {
            return track.source.substr(0, track.source.find('.')) == message;
        };
        const bool is_power = find_track(series, "power_w", is_of) != nullptr;
        if (!is_power && std::ranges::any_of(series.tracks, is_of))
            power.not_chosen.push_back(fmt::format("{} has no power in W, nor current in A with voltage", message));
    }
    return power;
}

}  // namespace flightwatt::flight
