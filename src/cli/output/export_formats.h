#pragma once

#include "cli/stage.h"

#include <string>
#include <vector>

/// What export makes of what.
namespace flightwatt::cli {

/// What an input is, by what it holds.
enum class ExportKind { flight, model, battery, mission, batch };

struct ExportInput {
    std::string file;
    ExportKind kind = ExportKind::flight;
};

struct ExportRequest {
    std::string format;  ///< "geojson"
    std::vector<ExportInput> inputs;
};

/// The format by --format or the ending of --output's file, and the inputs. Throws UsageError for no such format, for
/// options or a number of inputs that the format does not take; InputError for inputs that it is not made of.
ExportRequest read_export_request(const StageCall& call);

}  // namespace flightwatt::cli
