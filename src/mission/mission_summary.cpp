#include "mission/mission_summary.h"

#include "base/text.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::mission {
namespace {

/// Greater is better: what lasts, by the charge left; then what ended early, by how long it lasted.
std::pair<int, double> merit(const MissionSummary& summary) {
    if (!summary.final_soc_percent) return {0, 0.0};  // undeliverable
    if (summary.depleted_at_s || summary.cut_off_at_s) return {1, powered_end_s(summary)};
    return {2, *summary.final_soc_percent};
}

}  // namespace

std::string to_string(LimitingFactor bound) {
    constexpr std::array names{"charge", "power", "cut-off", "path"};
    return names.at(static_cast<std::size_t>(bound));
}

std::string to_string(ScheduleOrigin origin) {
    constexpr std::array names{"", "optimal", "planned", "no plan keeps the reserve", "replanned in flight"};
    return names.at(static_cast<std::size_t>(origin));
}

double powered_end_s(const MissionSummary& summary) {
    if (summary.undeliverable) return summary.undeliverable->time_s;
    return summary.depleted_at_s.value_or(summary.cut_off_at_s.value_or(summary.duration_s));
}

std::string describe(const UncertaintySources& sources) {
    auto text = fmt::format("drawn: {}",
                            sources.varied.empty() ? "nothing" : fmt::format("{}", fmt::join(sources.varied, ", ")));
    if (!sources.fixed.empty()) text += fmt::format("; not drawn: {}", fmt::join(sources.fixed, ", "));
    return text;
}

std::string describe(const EstimatedLanding& landing, int decimals) {
    const auto end = landing.fails_at_s ? "the battery fails after " + duration_text(*landing.fails_at_s)
                                        : fmt::format("{:.{}f} %", landing.final_soc_percent.value_or(0.0), decimals);
    return fmt::format("{} with the {:.3g} Ah that the flights indicate", end, landing.capacity_ah);
}

std::string describe(const mechanical::HeldOutScore& power_model) {
    const auto& model = power_model.model;
    const auto* used = model == "physical"        ? "cruise power by the physical model"
                       : model == "constant_mean" ? "power by each phase's mean"
                       : model == "by_phase"      ? "power by each phase's curve or mean"
                                                  : "power by each phase's curve";
    const auto* known = model == "physical" ? ", their airspeed and climb known" : "";
    return fmt::format("{}: {:.1f} % off on {} flights left out of the fit{}", used,
                       power_model.mean_absolute_error_percent, power_model.flights, known);
}

std::string describe(const path::SurveyLayout& layout) {
    std::vector<std::string> spacings;
    std::vector<std::string> speeds;
    const auto add = [](std::vector<std::string>& texts, double value) {
        auto text = fmt::format("{:.4g}", value);
        if (texts.empty() || texts.back() != text) texts.push_back(std::move(text));
    };
    for (const auto& strip : layout.strips) {
        add(spacings, strip.spacing_m);
        if (strip.airspeed_m_per_s) add(speeds, *strip.airspeed_m_per_s);
    }
    const auto text = fmt::format("lines {} m apart on {:.4g} degrees", fmt::join(spacings, ", "), layout.heading_deg);
    return speeds.empty() ? text : fmt::format("{} at {} m/s", text, fmt::join(speeds, ", "));
}

std::string describe(const MissionSummary& summary) {
    if (const auto& failure = summary.undeliverable) {
        return fmt::format("{}: the battery cannot deliver {:.6g} W after {}: its limit U^2 / (4 R) is {:.6g} W",
                           summary.mission, failure->power_w, duration_text(failure->time_s), failure->limit_w);
    }
    auto end = fmt::format("{:.2f} % left after {}", *summary.final_soc_percent, duration_text(summary.duration_s));
    if (summary.depleted_at_s) {
        end = fmt::format("empty after {} of {}", duration_text(*summary.depleted_at_s),
                          duration_text(summary.duration_s));
    } else if (summary.cut_off_at_s) {
        end = fmt::format("cut off after {} of {} with {:.2f} % left", duration_text(*summary.cut_off_at_s),
                          duration_text(summary.duration_s), *summary.final_soc_percent);
    } else if (!summary.keeps_reserve) {
        end += fmt::format(", less than the reserve of {:.6g} %", summary.reserve_soc_percent);
    }
    if (summary.lines) end += fmt::format("; {}, {:.3g} times seen", describe(*summary.lines), *summary.coverage);
    if (summary.by_flights) end += fmt::format(" ({})", describe(*summary.by_flights));
    if (summary.decisions && summary.decisions->without_plan > 0) {
        end += fmt::format(
            " (at {} of {} decisions no plan kept the reserve with its margin, and what "
            "demands least energy was run)",
            summary.decisions->without_plan, summary.decisions->made);
    }
    return fmt::format("{}: {}; {:.3f} Wh, {:.3f} mechanical and {:.3f} computing", summary.mission, end,
                       summary.energy_wh, summary.mechanical_energy_wh, summary.compute_energy_wh);
}

std::vector<MissionSummary> ranked(std::vector<MissionSummary> summaries) {
    std::ranges::stable_sort(summaries, [](const auto& a, const auto& b) { return merit(a) > merit(b); });
    return summaries;
}

}  // namespace flightwatt::mission
