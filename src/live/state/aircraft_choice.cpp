#include "live/state/aircraft_choice.h"

#include "flight/segmentation.h"
#include "flight/selected_track.h"

#include <algorithm>
#include <exception>
#include <utility>
#include <vector>

namespace flightwatt::live {
namespace {

bool has_flown(const flight::FlightSeries& series) {
    constexpr std::size_t min_samples = 2;
    if (flight::select_track(series, "altitude_m").time_s.size() < min_samples) return false;
    try {
        return !segment(series).sorties.empty();
    } catch (const std::exception&) {
        return false;
    }
}

}  // namespace

void AircraftSelector::count(std::string_view text) {
    const auto sender = text.substr(0, text.find(' '));
    if (messages_.contains(sender) || messages_.size() < max_named) ++messages_[std::string(sender)];
}

void AircraftSelector::keep(TelemetryStore& store) {
    if (is_locked_) return;
    is_locked_ = true;
    store.keep_only(chosen_);
}

flight::FlightSeries AircraftSelector::choose(TelemetryStore& store) {
    if (named_ && !is_locked_) {
        chosen_ = *named_;
        keep(store);
    }
    if (is_locked_) return store.series(chosen_);
    std::vector<flight::FlightSeries> candidates;
    for (const auto& id : store.senders()) candidates.push_back(store.series(id));
    if (candidates.empty()) return {};
    const auto count_of = [&](const flight::FlightSeries& series) {
        const auto found = messages_.find(series.aircraft_id);
        return found == messages_.end() ? std::size_t{0} : found->second;
    };
    auto chosen = std::ranges::max_element(candidates, {}, count_of);
    const auto others_flew = [&](const flight::FlightSeries& series) {
        return &series != &*chosen && has_flown(series);
    };
    if (std::ranges::any_of(candidates, others_flew)) chosen = std::ranges::find_if(candidates, has_flown);
    chosen_ = chosen->aircraft_id;
    return std::move(*chosen);
}

std::map<std::string, std::size_t> AircraftSelector::others() const {
    std::map<std::string, std::size_t> others(messages_.begin(), messages_.end());
    others.erase(chosen_);
    return others;
}

}  // namespace flightwatt::live
