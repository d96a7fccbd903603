#include "cli/output/json_document.h"

#include <utility>

namespace flightwatt::cli {

Json json_document(const StageCall& call, const Json& record) {
    constexpr std::string_view prefix = "flightwatt-";
    Json json{{"format", json_format}, {"stage", call.program.substr(prefix.size())}};
    json.update(record);
    return json;
}

Json json_schema(std::vector<Json> forms) {
    for (auto& form : forms) {
        Json properties{{"format", {{"const", json_format}, {"description", "format of this JSON"}}},
                        {"stage", {{"type", "string"}, {"description", "name of the stage"}}}};
        properties.update(form["properties"]);
        form["properties"] = std::move(properties);
        form["required"].insert(form["required"].begin(), {"format", "stage"});
    }
    Json schema{{"$schema", "https://json-schema.org/draft/2020-12/schema"}};
    if (forms.size() == 1)
        schema.update(forms.front());
    else
        schema["anyOf"] = std::move(forms);
    return schema;
}

}  // namespace flightwatt::cli
