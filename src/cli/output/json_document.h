#pragma once

#include "cli/stage.h"
#include "flight/flight_phases.h"
#include "record/record.h"

#include <string>
#include <vector>

/// The JSON of stages: an object that begins with "format" and "stage", then the fields of a record.
namespace flightwatt::cli {

/// Raised with every change of a key that readers have to know.
inline constexpr int json_format = 1;

/// The object with "format" and "stage" first.
Json json_document(const StageCall& call, const Json& record);

/// Prints a record as the JSON of the stage.
template <Record R>
void print_json(const StageCall& call, const R& record) {
    print(json_text(json_document(call, record_json(record))));
}

Json json_schema(std::vector<Json> forms);

/// For StageDefinition::json_schema: the schema of documents that are one of these records.
template <Record... Forms>
Json document_schema() {
    return json_schema({record_schema<Forms>()...});
}

/// A list of keys and values by phase: "takeoff", "cruise", "landing".
template <typename PerPhase>
auto by_phase(const PerPhase& values) {
    Keyed<std::remove_cvref_t<decltype(values.values[0])>> all;
    for (const auto phase : flight::all_phases) all.emplace_back(std::string(to_string(phase)), values[phase]);
    return all;
}

}  // namespace flightwatt::cli
