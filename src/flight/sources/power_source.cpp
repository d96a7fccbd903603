#include "flight/sources/power_source.h"

#include "flight/sources/derived_tracks.h"
#include "flight/sources/device_sum.h"
#include "flight/sources/outliers.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include <fmt/format.h>

namespace flightwatt::flight {
namespace {

/// The first candidate of power that `accept` takes; nullptr if there is none.
template <typename Accept>
const Track* find_power(const FlightSeries& series, Accept&& accept) {
    const auto found = std::ranges::find_if(
        series.tracks, [&](const Track& track) { return track.name == "power_w" && accept(track); });
    return found == series.tracks.end() ? nullptr : &*found;
}

const Track* find_source(const FlightSeries& series, std::string_view source) {
    return find_power(series, [&](const Track& track) { return track.source == source; });
}

/// Voltage times current of one message; nullptr if it lacks one of them.
const Track* find_product(const FlightSeries& series, std::string_view message) {
    return find_power(series, [&](const Track& track) {
        return track.source.starts_with(message) && track.source.find(" * ") != std::string::npos &&
               track.device.empty();
    });
}

/// A track that no message of a log names: a user's CSV.
const Track* find_plain(const FlightSeries& series, std::string_view name) {
    const auto found = std::ranges::find_if(series.tracks, [&](const Track& track) {
        return track.name == name && track.device.empty() && track.source.find('.') == std::string::npos;
    });
    return found == series.tracks.end() ? nullptr : &*found;
}

/// Calls visit(a, b) for the values of both tracks at the times that they share.
template <typename Visit>
void for_each_pair(const Track& a, const Track& b, Visit&& visit) {
    for (std::size_t i = 0, j = 0; i < a.time_s.size(); ++i) {
        while (j < b.time_s.size() && b.time_s[j] < a.time_s[i]) ++j;
        if (j < b.time_s.size() && b.time_s[j] == a.time_s[i]) visit(a.value[i], b.value[j]);
    }
}

/// True if most samples are nowhere near voltage times current: another layout of the message than was assumed.
bool contradicts(const Track& power, const Track& product) {
    std::size_t compared = 0;
    std::size_t apart = 0;
    for_each_pair(power, product, [&](double power_w, double product_w) {
        if (std::abs(product_w) <= 1.0) return;
        ++compared;
        if (std::abs(power_w - product_w) > 0.2 * std::abs(product_w)) ++apart;
    });
    return compared >= 10 && 2 * apart > compared;
}

/// How many samples of `power` are near to voltage times current.
std::size_t samples_near(const Track& power, const Track& product) {
    std::size_t near = 0;
    for_each_pair(power, product, [&](double power_w, double product_w) {
        if (std::abs(product_w) <= 1.0) return;
        const double tolerance_w = 0.05 * std::abs(product_w) + 1.0;  // power may be a whole number
        if (std::abs(power_w - product_w) <= tolerance_w) ++near;
    });
    return near;
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

/// Takes a candidate if it measures something, or says why not.
bool take(const FlightSeries& series, const Track& candidate, PowerSelection& choice,
          const std::vector<double>& contradicted_s = {}) {
    auto sound = remove_outliers(candidate, contradicted_s, dropout_throttle(series, candidate));
    if (measures_something(sound.of(candidate))) {
        choice.power_w = sound.take(candidate);
        if (!sound.removal_note.empty()) choice.left_out.push_back(std::move(sound.removal_note));
        return true;
    }
    if (sound.of(candidate).empty() && !sound.removal_note.empty()) {
        choice.passed_over.push_back(std::move(sound.removal_note));
        return false;
    }
    choice.passed_over.push_back(candidate.source +
                                 (candidate.time_s.size() < 2 ? " has no two finite values" : " is 0 throughout"));
    return false;
}

/// The field ENERGY.power, wherever it stands in the message.
Track energy_power(const FlightSeries& series) {
    if (energy_and_power_are_swapped(series)) {
        auto track = *find_source(series, energy_read_as_power);
        track.source = "ENERGY.power";
        return track;
    }
    const auto* track = find_source(series, "ENERGY.power");
    return track == nullptr ? Track{} : *track;
}

}  // namespace

bool energy_and_power_are_swapped(const FlightSeries& series) {
    const auto* as_read = find_source(series, "ENERGY.power");
    const auto* other = find_source(series, energy_read_as_power);
    const auto* product = find_product(series, "ENERGY.");
    if (as_read == nullptr || other == nullptr || product == nullptr) return false;
    const auto exchanged = samples_near(*other, *product);
    return exchanged >= 10 && exchanged > 2 * samples_near(*as_read, *product);
}

std::vector<double> contradicted_times(const FlightSeries& series, std::string_view source) {
    if (source.find('.') == std::string_view::npos) {
        const auto* power = find_plain(series, "power_w");
        return power == nullptr ? std::vector<double>{} : inconsistent_times(*power, plain_product(series));
    }
    const auto* product = find_product(series, source.substr(0, source.find('.') + 1));
    if (product == nullptr || !source.starts_with("ENERGY.")) return {};
    return inconsistent_times(energy_power(series), *product);
}

Track dropout_throttle(const FlightSeries& series, const Track& candidate) {
    if (std::ranges::find(candidate.value, 0.0) == candidate.value.end()) return {};
    const auto found = std::ranges::find_if(series.tracks, [](const Track& track) {
        return track.name == "throttle_percent" && track.device.empty() && track.source != commanded_throttle &&
               !is_constant(track);
    });
    return found == series.tracks.end() ? Track{} : within_bounds(*found);
}

PowerSelection select_power(const FlightSeries& series) {
    PowerSelection choice;
    if (const auto* plain = find_plain(series, "power_w")) {
        // Believed even where it is 0 throughout.
        auto sound =
            remove_outliers(*plain, contradicted_times(series, plain->source), dropout_throttle(series, *plain));
        choice.power_w = sound.take(*plain);
        if (!sound.removal_note.empty()) choice.left_out.push_back(std::move(sound.removal_note));
        return choice;
    }
    const auto* product = find_product(series, "ENERGY.");
    if (const auto power = energy_power(series); !power.source.empty()) {
        if (product != nullptr && contradicts(power, *product)) {
            choice.passed_over.emplace_back("ENERGY.power is not voltage times current");
        } else if (take(series, power, choice, contradicted_times(series, power.source))) {
            return choice;
        }
    }
    if (product != nullptr && take(series, *product, choice)) return choice;
    const auto is_bat = [](const Track& track) { return track.source.starts_with("BAT."); };
    if (std::ranges::any_of(series.tracks, is_bat)) {
        const auto* bat = find_product(series, "BAT.");
        if (bat == nullptr) choice.passed_over.emplace_back("BAT has no current");
        if (bat != nullptr && take(series, *bat, choice)) return choice;
    }
    for (const auto* message : {"ESC", "POWER_DEVICE"}) {
        auto sum = sum_over_devices(series, "power_w", message);
        if (!sum.ambiguity.empty()) choice.passed_over.push_back(std::move(sum.ambiguity));
        if (sum.track.source.empty() || !take(series, sum.track, choice)) continue;
        std::ranges::move(sum.notes, std::back_inserter(choice.left_out));
        return choice;
    }
    for (const auto* message : {"ENERGY", "ESC", "POWER_DEVICE"}) {
        const auto is_of = [&](const Track& track) {
            return track.source.substr(0, track.source.find('.')) == message;
        };
        const bool is_power = find_power(series, is_of) != nullptr;
        if (!is_power && std::ranges::any_of(series.tracks, is_of))
            choice.passed_over.push_back(fmt::format("{} has no power in W, nor current in A with voltage", message));
    }
    return choice;
}

}  // namespace flightwatt::flight
