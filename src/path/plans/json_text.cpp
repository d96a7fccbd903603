#include "path/plans/json_text.h"

#include "base/error.h"
#include "base/text.h"

#include <fmt/format.h>

namespace flightwatt::path {

Json parse_json(std::string_view text, const std::string& file, const std::string& hint) {
    const auto location_at = [&](std::size_t offset) { return Location{file, line_of_offset(text, offset)}; };
    try {
        return Json::parse(text);
    } catch (const Json::parse_error& error) {
        throw InputError(location_at(error.byte == 0 ? 0 : error.byte - 1), "is not JSON", hint);
    } catch (const Json::out_of_range& error) {  // names the number in quotation marks, and no place
        std::string number = error.what();
        number = number.substr(number.find('\'') + 1);
        number = number.substr(0, number.find('\''));
        throw InputError(location_at(text.find(number)), fmt::format("a number is out of range: '{}'", number),
                         "expected a coordinate");
    }
}

}  // namespace flightwatt::path
