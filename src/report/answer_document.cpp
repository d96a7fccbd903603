#include "report/answer_document.h"

#include "record/record.h"

#include <algorithm>

namespace flightwatt::report {

Json answer_json(const cli::AircraftAnswer& answer, const std::vector<std::pair<std::string, std::string>>& pastes) {
    auto json = record_json(answer);
    for (const auto* key : {"folder", "page"}) json.erase(key);
    json["headline"] = aircraft_line(answer);
    json["lines"] = Json::array();
    for (const auto& [label, text, on_terminal] : answer_lines(answer)) {
        // The value, or "unknown", is before what it rests on.
        const auto end = std::min({text.find(" ("), text.find("; "), text.find(": "), text.size()});
        json["lines"].push_back({{"label", label}, {"value", text.substr(0, end)}, {"basis", text.substr(end)}});
    }
    json["pastes"] = Json::array();
    for (const auto& [name, text] : pastes) json["pastes"].push_back({{"name", name}, {"text", text}});
    return json;
}

}  // namespace flightwatt::report
