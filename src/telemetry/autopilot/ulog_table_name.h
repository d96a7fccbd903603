#pragma once

#include <cstddef>
#include <string>
#include <string_view>

/// Names of the tables that ulog2csv writes of a log: LOG_TOPIC_INSTANCE.csv.
namespace flightwatt::telemetry {

/// Topics of which every log of a flight has at least one; the file of the first that a folder has represents the log.
inline constexpr const char* representative_topics[] = {"battery_status", "vehicle_air_data", "vehicle_global_position",
                                                        "vehicle_local_position", "vehicle_gps_position"};

/// Begins the line before each table in the joined text of a log; topic, instance and file follow.
inline constexpr std::string_view ulog_table_marker = "# ulog2csv ";

/// Returns the position of "_0" in "log_battery_status_0"; npos if the name does not end in an instance.
inline std::size_t instance_mark(const std::string& name) {
    const auto mark = name.find_last_not_of("0123456789");
    return mark == std::string::npos || mark + 1 == name.size() || name[mark] != '_' ? std::string::npos : mark;
}

/// Returns the name of the log that a table represents: "log" for "log_battery_status_0". Returns other names
/// unchanged.
inline std::string without_topic(std::string name) {
    if (const auto mark = instance_mark(name); mark != std::string::npos)
        for (const std::string topic : representative_topics)
            if (name.substr(0, mark).ends_with("_" + topic)) return name.substr(0, mark - topic.size() - 1);
    return name;
}

}  // namespace flightwatt::telemetry
