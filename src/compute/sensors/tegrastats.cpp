#include "compute/sensors/tegrastats.h"

#include "base/error.h"
#include "base/number.h"
#include "base/units.h"
#include "compute/sensors/power_rail.h"

#include <chrono>
#include <iomanip>
#include <regex>
#include <sstream>
#include <vector>

#include <fmt/format.h>

namespace flightwatt::compute {
namespace {

/// Name, power now, average. What is no power either has another unit ("RAM 2448/7850MB") or no slash.
const std::regex& rail_pattern() {
    static const std::regex pattern(R"((\w+) (\d+)(?:mW)?/\d+(?:mW)?(?=\s|$))");
    return pattern;
}

struct Rails {
    std::vector<std::string> names;
    std::vector<double> power_mw;
};

Rails rails_of(const std::string& line) {
    Rails rails;
    for (std::sregex_iterator it(line.begin(), line.end(), rail_pattern()), end; it != end; ++it) {
        rails.names.push_back((*it)[1].str());
        rails.power_mw.push_back(number_or_nan((*it)[2].str()));
    }
    return rails;
}

/// The date that newer versions begin a line with, in seconds of the epoch.
std::optional<double> date_s(const std::string& line) {
    std::tm date{};
    std::istringstream text(line);
    if (!(text >> std::get_time(&date, "%m-%d-%Y %H:%M:%S"))) return std::nullopt;
    namespace chrono = std::chrono;
    const chrono::year_month_day day{chrono::year(date.tm_year + 1900),
                                     chrono::month(static_cast<unsigned>(date.tm_mon) + 1U),
                                     chrono::day(static_cast<unsigned>(date.tm_mday))};
    const auto time = chrono::sys_days(day) + chrono::hours(date.tm_hour) + chrono::minutes(date.tm_min) +
                      chrono::seconds(date.tm_sec);
    return chrono::duration<double>(time.time_since_epoch()).count();
}

double total_w(const Rails& rails, const Location& where) {
    const auto chosen = rails_of_total(rails.names, {});
    if (chosen.empty()) {
        throw InputError(where, "has no rail with its power, 'VDD_IN 4936mW/4936mW'",
                         "keep tegrastats' lines whole");
    }
    double power_mw = 0.0;
    for (const auto rail : chosen) power_mw += rails.power_mw[rail];
    return units::watt_from_milliwatt(power_mw);
}

}  // namespace

bool is_tegrastats(const std::string& line) { return std::regex_search(line, rail_pattern()); }

PowerTrace parse_tegrastats(std::string_view text, const std::string& file,
                            std::optional<double> interval_s) {
    PowerTrace trace;
    std::optional<double> first_date_s;
    std::istringstream lines{std::string(text)};
    std::string line;
    Location where{file};
    while (std::getline(lines, line)) {
        ++where.line;
        if (line.empty() || line.front() == '#') continue;
        const auto now_s = date_s(line);
        if (!first_date_s) first_date_s = now_s;
        if (!interval_s && !now_s) {
            throw InputError(where, "has no date and no interval is given",
                             "give the sampler's interval_s, tegrastats --interval");
        }
        const double time_s =
            interval_s ? static_cast<double>(trace.time_s.size()) * *interval_s : *now_s - *first_date_s;
        if (!trace.time_s.empty() && time_s <= trace.time_s.back()) {
            throw InputError(where, "its date is not after the line before",
                             "dates count whole seconds: give the sampler's interval_s");
        }
        trace.time_s.push_back(time_s);
        trace.power_w.push_back(total_w(rails_of(line), where));
    }
    return trace;
}

}  // namespace flightwatt::compute
