#include "report/answer_section.h"

#include <algorithm>

#include <fmt/format.h>

namespace flightwatt::report {

Section answer_section(const cli::AircraftAnswer& answer,
                       const std::vector<std::pair<std::string, std::string>>& pastes) {
    Section section{"answer", "Answer"};
    section.place = SectionPlace::front;
    section.html = fmt::format("<h1 id=\"answer-title\">{}</h1>\n<dl class=\"card answer\">\n",
                               html_escaped(aircraft_line(answer)));
    for (const auto& [label, text, on_terminal] : answer_lines(answer)) {
        // The value, or "unknown", is before what it rests on.
        const auto end = std::min({text.find(" ("), text.find("; "), text.find(": "), text.size()});
        section.html += fmt::format("<dt>{}</dt><dd><b>{}</b>{}</dd>\n", html_escaped(label),
                                    html_escaped(text.substr(0, end)), html_escaped(text.substr(end)));
    }
    section.html += "</dl>\n";
    for (const auto& [name, text] : pastes)
        section.html += fmt::format("<details class=\"more\"><summary>{}</summary>\n<pre>{}</pre></details>\n",
                                    html_escaped(name), html_escaped(text));
    return section;
}

}  // namespace flightwatt::report
