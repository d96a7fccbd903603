#pragma once

#include "cli/stage.h"
#include "live/sources.h"

#include <memory>
#include <optional>
#include <string>

#include <boost/program_options.hpp>

/// The options that say where the telemetry of a flight in the air comes from.
namespace flightwatt::cli {

/// --follow, --udp, --serial, --ivy, --clock-factor, --log, --messages.
void add_source_options(boost::program_options::options_description& options);

/// The file of definitions: of --messages or --log, or the .log beside the file that is followed.
std::optional<std::string> definitions_of_source(const StageCall& call);

/// The one source that was named, opened: by these options, or - as the standard input.
std::unique_ptr<live::MessageSource> open_source(const StageCall& call);

}  // namespace flightwatt::cli
