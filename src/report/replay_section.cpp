#include "report/replay_section.h"

#include "cli/output/replay_output.h"

#include <algorithm>

#include <fmt/format.h>

namespace flightwatt::report {
namespace {

constexpr int replay_width = 640;
constexpr int replay_height = 260;

/// Utility over the charge left, a point a flight and schedule.
Figure replay_figure(const std::vector<const mission::Replay*>& replays, const std::string& id) {
    FigureData data({"soc", "utility"}, {"flight", "schedule"});
    auto description =
        fmt::format("{}: utility and final state of charge of each schedule on each flight.", replays.front()->mission);
    double reserve_percent = 0.0;
    for (const auto* replay : replays) {
        for (const auto& replayed : replay->schedules) {
            const auto& summary = replayed.summary;
            if (!summary.final_soc_percent || !summary.utility) continue;
            reserve_percent = summary.reserve_soc_percent;
            const auto way = to_string(replayed.way);
            data.add({*summary.final_soc_percent, *summary.utility}, {replay->flight, way});
            description += fmt::format(" {}, {}: {:.4g} at {:.2f} %.", replay->flight, way, *summary.utility,
                                       *summary.final_soc_percent);
        }
    }
    auto figure = new_figure(id,
                             "Utility over final state of charge, by schedule and flight. To the left of the line the "
                             "reserve is not kept; what runs after the battery's end counts nothing.",
                             description);
    figure.spec["width"] = replay_width;
    figure.spec["height"] = replay_height;
    const VegaJson encoding{
        {"x", numeric_channel("soc", "final state of charge [%]")},
        {"y", numeric_channel("utility", "utility")},
        {"color", nominal_channel("schedule", "schedule")},
        {"shape", nominal_channel("flight", "flight")},
        {"tooltip",
         {nominal_channel("flight", "flight"), nominal_channel("schedule", "schedule"),
          tooltip_number("utility", "utility", ".4f"), tooltip_number("soc", "final state of charge [%]", ".2f")}}};
    const VegaJson reserve{{"values", {{{"reserve", reserve_percent}}}}};
    figure.spec["layer"] = {
        layer(reserve, R"({"type": "rule", "strokeDash": [4, 3]})", {{"x", numeric_channel("reserve", "")}}),
        layer(data.json(), R"({"type": "point", "size": 70})", encoding)};
    figure.spec["layer"][0]["encoding"]["x"]["title"] = "final state of charge [%]";
    return figure;
}

constexpr auto results_caption = "What each schedule came to on each flight";
constexpr auto basis_caption = "What the replays rest on";

}  // namespace

std::vector<CaptionedTable> replay_tables(std::span<const mission::Replay> replays) {
    return {{cli::replay_table(replays), results_caption, "tab:replay"},
            {cli::replay_basis_table(replays), basis_caption, "tab:replay-basis"}};
}

Section replay_section(std::span<const mission::Replay> replays) {
    Section section{"replay", "Replay"};
    section.html += paragraph(
        "The missions' schedules on the power that the flights measured. What is known before each flight is a model "
        "of the other flights alone; hindsight plans by what was measured, and regret is the utility that it has more.");
    std::vector<std::string> drawn;
    for (const auto& replay : replays) {
        if (replay.schedules.size() <= 2 || std::ranges::count(drawn, replay.mission) > 0) continue;
        drawn.push_back(replay.mission);
        std::vector<const mission::Replay*> of_mission;
        for (const auto& other : replays)
            if (other.mission == replay.mission) of_mission.push_back(&other);
        section.html += "<h3>" + html_escaped(replay.mission) + "</h3>\n";
        add_figure(section, replay_figure(of_mission, fmt::format("replay-{}", drawn.size())));
    }
    section.html += list_html(cli::replay_sentences(replays));
    section.html += table_html(cli::replay_table(replays), {results_caption, true, {}});
    section.html += table_html(cli::replay_basis_table(replays), {basis_caption, true, {}});
    std::vector<std::string> notes;
    for (const auto& replay : replays)
        for (const auto& note : replay.notes)
            notes.push_back(fmt::format("{}, {}: {}", replay.flight, replay.mission, note));
    notes.push_back(cli::replay_remark());
    section.html += "<div class=\"soft\">" + list_html(notes) + "</div>\n";
    return section;
}

}  // namespace flightwatt::report
