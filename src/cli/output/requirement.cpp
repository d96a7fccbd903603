#include "cli/output/requirement.h"

#include "base/error.h"
#include "base/number.h"
#include "base/text.h"

#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::cli {
namespace {

constexpr std::size_t usual_samples = 10000;

void parse_requirement(Requirement& requirement) {
    constexpr std::string_view kept = "reserve";
    if (!requirement.text || *requirement.text == kept) return;
    const std::string_view text = *requirement.text;
    const auto probability =
        text.starts_with("reserve=") ? parse_number(text.substr(kept.size() + 1)) : std::optional<double>();
    if (!probability || *probability <= 0.0 || *probability >= 1.0)
        throw UsageError(
            fmt::format("--require {}: expected reserve, or reserve=P with a probability P between 0 and "
                        "1: 95 % is reserve=0.95",
                        one_line(std::string(text))));
    requirement.probability = probability;
}

}  // namespace

void add_require_option(Options& options, Requirement& requirement, SamplingArguments& sampling) {
    options.add("require", requirement.text, {.value = "reserve[=P]"},
                "exit with 5 unless the mission keeps its reserve as modelled, or with probability P (0.95) over drawn "
                "flights");
    options.add_rule([&] {
        parse_requirement(requirement);
        if (requirement.probability && !sampling.samples) sampling.samples = usual_samples;
    });
}

std::optional<std::string> reason_missed(const Requirement& requirement, const mission::MissionSummary& summary) {
    if (!requirement.text) return std::nullopt;
    const auto& [text, probability] = requirement;
    if (summary.undeliverable || (!probability && !summary.keeps_reserve)) return describe(summary);
    if (!summary.uncertain.empty())
        return fmt::format("{}: whether it keeps the reserve is uncertain: {}", summary.mission,
                           fmt::join(summary.uncertain, "; "));
    if (!probability) return std::nullopt;
    const auto& drawn = summary.samples;
    if (!drawn || !drawn->variability_is_known)
        return fmt::format(
            "{}: the probability of keeping the reserve is unknown, as nothing shows how the power of flights differs; "
            "fit the model to two flights or more, or state [uncertainty]",
            summary.mission);
    const double kept = 1.0 - drawn->probability_below_reserve;
    if (kept >= *probability) return std::nullopt;
    return fmt::format("{}: keeps the reserve of {:.6g} % with probability {:.4f}, required {:g}", summary.mission,
                       summary.reserve_soc_percent, kept, *probability);
}

ExitCode report_missed(const StageCall& call, const std::string& reason) {
    add_diagnostic(call, {.severity = Severity::error, .text = "--require: " + reason});
    return requirement_missed;
}

ExitCode check_requirement(const StageCall& call, const Requirement& requirement,
                           const std::vector<mission::MissionSummary>& missions) {
    auto code = ok;
    for (const auto& summary : missions) {
        if (const auto reason = reason_missed(requirement, summary)) code = report_missed(call, *reason);
    }
    return code;
}

}  // namespace flightwatt::cli
