#include "mission/planning/survey_layouts.h"

#include <algorithm>
#include <cmath>

namespace flightwatt::mission {
namespace {

/// Parts of the width nearer than this are one.
constexpr double same_part = 1e-9;

/// Appends the layouts that continue one which is decided up to a part of the width.
void append_continued(const SurveyChoices& choices, const path::SurveyLayout& decided, double from,
                      std::vector<path::SurveyLayout>& layouts) {
    if (from >= 1.0 - same_part) {
        layouts.push_back(decided);
        return;
    }
    const auto blocks = static_cast<double>(choices.blocks);
    const double block_end = (std::floor(from * blocks + same_part) + 1.0) / blocks;
    const double to = block_end < 1.0 - same_part ? block_end : 1.0;
    for (const auto& level : choices.levels) {
        auto longer = decided;
        longer.strips.push_back(level);
        longer.strips.back().to = to;
        append_continued(choices, longer, to, layouts);
    }
}

}  // namespace

std::vector<path::SurveyLayout> all_layouts(const SurveyChoices& choices) {
    std::vector<path::SurveyLayout> layouts;
    for (const double heading_deg : choices.headings_deg) append_continued(choices, {heading_deg, {}}, 0.0, layouts);
    return layouts;
}

std::vector<path::SurveyLayout> remaining_layouts(const SurveyChoices& choices, const SurveyCoverage& survey,
                                                  double cruise_s) {
    std::vector<path::SurveyLayout> layouts;
    path::SurveyLayout decided{survey.layout.heading_deg, {}};
    if (cruise_s <= 0.0) {
        append_continued(choices, decided, 0.0, layouts);
        return layouts;
    }
    const auto now = std::ranges::find_if(survey.lines, [&](const auto& line) { return line.end_s > cruise_s; });
    if (now == survey.lines.end() || now->to >= 1.0 - same_part || survey.lines.front().start_s > cruise_s) return {};
    for (const auto& strip : survey.layout.strips) {
        decided.strips.push_back(strip);
        if (strip.to < now->to - same_part) continue;
        decided.strips.back().to = std::min(strip.to, now->to);
        break;
    }
    append_continued(choices, decided, now->to, layouts);
    return layouts;
}

}  // namespace flightwatt::mission
