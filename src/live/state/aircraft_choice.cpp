#include "live/state/aircraft_choice.h"

#include "flight/segmentation.h"
#include "flight/selected_track.h"

#include <exception>

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

flight::FlightSeries AircraftSelector::choose(TelemetryStore& store) {
    if (named_ && !is_locked_) {
        chosen_ = *named_;
        is_locked_ = true;
        store.keep_only(chosen_);
    }
    if (is_locked_) return store.series(chosen_);
    const auto senders = store.senders();
    const auto count_of = [&](const std::string& id) {
        const auto found = messages_.find(id);
        return found == messages_.end() ? std::size_t{0} : found->second;
    };
    std::optional<flight::FlightSeries> most;
    for (const auto& id : senders) {
        auto series = store.series(id);
        if (has_flown(series)) {
            chosen_ = id;
            is_locked_ = true;
            store.keep_only(id);
            return series;
        }
        if (!most || count_of(id) > count_of(most->aircraft_id)) most = std::move(series);
    }
    if (!most) return {};
    chosen_ = most->aircraft_id;
    return std::move(*most);
}

std::map<std::string, std::size_t> AircraftSelector::others() const {
    std::map<std::string, std::size_t> others(messages_.begin(), messages_.end());
    others.erase(chosen_);
    return others;
}

}  // namespace flightwatt::live
