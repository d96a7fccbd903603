#include "telemetry/telemetry_log.h"

#include <algorithm>

namespace flightwatt::telemetry {

const Column* MessageTable::column(std::string_view field) const {
    const auto found = std::ranges::find(columns, field, &Column::field);
    return found == columns.end() ? nullptr : &*found;
}

const MessageTable* SenderLog::table(std::string_view message) const {
    const auto found = std::ranges::find(tables, message, &MessageTable::message);
    return found == tables.end() ? nullptr : &*found;
}

}  // namespace flightwatt::telemetry
