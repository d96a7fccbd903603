#pragma once

#include "telemetry/telemetry_log.h"

#include <cstddef>
#include <map>
#include <string>
#include <vector>

/// Content of a log that defines its own messages.
namespace flightwatt::telemetry {

/// What a log states in addition to the columns of its messages.
struct LogFacts {
    std::map<std::string, std::string> information;  ///< ULog's, by key: "sys_uuid"
    std::map<std::string, double> parameters;
    std::vector<std::string> texts;  ///< messages to the user, at most a thousand
    std::size_t dropouts = 0;        ///< times at which ULog's logger lost data
    double dropout_s = 0.0;          ///< in all
};

struct AutopilotLog {
    TelemetryLog log;  ///< of one sender, with an empty id
    LogFacts facts;
};

/// A message, its number in the log, and its fields.
struct AutopilotMessage {
    std::string name;
    std::size_t count = 0;
    std::vector<std::string> fields;
};

}  // namespace flightwatt::telemetry
