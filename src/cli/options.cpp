#include "cli/options.h"

#include "base/error.h"
#include "base/number.h"
#include "base/text.h"
#include "base/toml_reader.h"
#include "base/units.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <regex>
#include <sstream>

#include <boost/algorithm/string/replace.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flightwatt::cli {
namespace {

namespace po = boost::program_options;

constexpr const char* inputs_name = "inputs";

/// "more than 0 and at most 200 Ah", "1 to 24", "0.5 or more and less than 1".
std::string range_text(const Option& option) {
    const auto unit = option.unit.empty() ? "" : " " + option.unit;
    const bool has_min = std::isfinite(option.min);
    const bool has_max = std::isfinite(option.max);
    if (!has_min && !has_max) return "a number" + unit;
    if (has_min && has_max && !option.above_min && !option.below_max)
        return fmt::format("{:g} to {:g}{}", option.min, option.max, unit);
    const auto low = has_min
                         ? fmt::format(fmt::runtime(option.above_min ? "more than {:g}" : "{:g} or more"), option.min)
                         : std::string();
    const auto high =
        has_max ? fmt::format("{} {:g}", option.below_max ? "less than" : "at most", option.max) : std::string();
    return low + (has_min && has_max ? " and " : "") + high + unit;
}

/// A time in seconds of "90", "90s", "30min" or "1.5h"; std::nullopt for other texts.
std::optional<double> parse_time_s(std::string_view text) {
    constexpr std::array<std::pair<std::string_view, double>, 3> time_units{
        {{"min", units::seconds_per_minute}, {"h", units::seconds_per_hour}, {"s", 1.0}}};
    for (const auto& [unit, seconds] : time_units) {
        if (!text.ends_with(unit)) continue;
        const auto number = parse_number(text.substr(0, text.size() - unit.size()));
        return number ? std::optional(*number * seconds) : std::nullopt;
    }
    return parse_number(text);
}

std::string integer_range_text(const Option& option) {
    if (std::isfinite(option.max)) return fmt::format(" from {:.0f} to {:.0f}", std::max(option.min, 0.0), option.max);
    return option.min > 0.0 ? fmt::format(" from {:.0f}", option.min) : std::string();
}

[[noreturn]] void refuse(const Option& option, const std::string& text, const std::string& expected) {
    const auto hint = option.hint.empty() ? "" : "; " + option.hint;
    throw UsageError(fmt::format("--{} {}: expected {}{}", option.name, one_line(text), expected, hint));
}

std::string value_text(const Option& option) {
    return option.value + (option.default_text.empty() ? "" : fmt::format(" (={})", option.default_text));
}

po::value_semantic* semantic_of(const Option& option) {
    if (option.type == "flag") return po::bool_switch();
    if (option.is_repeatable) return po::value<std::vector<std::string>>()->composing()->value_name(value_text(option));
    return po::value<std::string>()->value_name(value_text(option));
}

std::string declared_name(const Option& option) {
    return option.name + (option.short_name.empty() ? "" : "," + option.short_name);
}

void add_to(po::options_description& description, const Option& option) {
    description.add_options()(declared_name(option).c_str(), semantic_of(option), option.description.c_str());
}

/// Which stages have what a pilot asks of a flight; empty for other options.
std::string_view stages_with(std::string_view name) {
    for (const auto* asked : {"--wind", "--payload", "--mass", "--airspeed", "--reserve"})
        if (name == asked) return "answer, check and new-mission have it; a mission states it in its file";
    if (name == "--capacity") return "answer and battery have it; a mission states capacity_ah in its file";
    if (name == "--home-distance") return "answer and export have it";
    return name == "--temperature" ? "answer has it" : "";
}

[[noreturn]] void refuse_unknown_option(const std::string& name, const std::string& reason,
                                        const std::vector<Option>& known) {
    if (const auto where = stages_with(name); !where.empty()) throw UsageError(fmt::format("{}; {}", reason, where));
    std::vector<std::string> names(known.size());
    std::ranges::transform(known, names.begin(), [](const auto& option) { return "--" + option.name; });
    throw UsageError(fmt::format("{}; {}", reason, meant_or(name, names, "see --help")));
}

/// The texts of an option, under its name or its old one.
std::vector<std::string> texts_of(const po::variables_map& values, const Option& option) {
    for (const auto& name : {option.name, option.old_name}) {
        if (values.count(name) == 0) continue;
        if (option.type != "flag")
            return option.is_repeatable ? values[name].as<std::vector<std::string>>()
                                        : std::vector{values[name].as<std::string>()};
        if (values[name].as<bool>()) return {"true"};
    }
    return {};
}

}  // namespace

std::string default_text(const Option& option, double value) { return fmt::format("{:g}", value / option.scale); }

double parse_number_option(const Option& option, const std::string& text) {
    const bool is_time = option.unit == "s" || option.unit.starts_with("s ");
    const auto number = is_time ? parse_time_s(text) : parse_number(text);
    const bool fits = number && std::isfinite(*number) &&
                      (option.above_min ? *number > option.min : *number >= option.min) &&
                      (option.below_max ? *number < option.max : *number <= option.max);
    const auto range = range_text(option);
    const bool lacks_number = !number && !range.starts_with("a number");
    const auto* kind = is_time ? "a time as 90s, 30min or 1.5h, " : "a number without a unit, ";
    const auto pointed = boost::replace_all_copy(text, ",", ".");
    if (!number && pointed != text && parse_number(pointed))
        refuse(option, text, fmt::format("{}, with a decimal point instead of the comma", pointed));
    if (!fits) refuse(option, text, (lacks_number ? kind : "") + range);
    return *number;
}

std::uint64_t parse_integer_option(const Option& option, const std::string& text) {
    const auto number = parse_unsigned(text);
    const auto as_double = static_cast<double>(number.value_or(0));
    if (!number || as_double < option.min || as_double > option.max)
        refuse(option, text, "a whole number" + integer_range_text(option));
    return *number * static_cast<std::uint64_t>(option.scale);
}

std::size_t parse_choice_option(const Option& option, const std::string& text) {
    const auto found = std::ranges::find(option.choices, text);
    if (found == option.choices.end()) {
        const auto near = nearest_word(text, option.choices);
        refuse(option, text,
               fmt::format("one of {}{}", fmt::join(option.choices, ", "),
                           near.empty() ? "" : fmt::format("; did you mean '{}'?", near)));
    }
    return static_cast<std::size_t>(found - option.choices.begin());
}

std::chrono::sys_days parse_date_option(const Option& option, const std::string& text) {
    static const std::regex date("([0-9]{4})-([0-9]{2})-([0-9]{2})");
    std::smatch match;
    if (std::regex_match(text, match, date)) {
        const auto number = [&](std::size_t part) { return std::stoi(match[part].str()); };
        const std::chrono::year_month_day day{std::chrono::year(number(1)),
                                              std::chrono::month(static_cast<unsigned>(number(2))),
                                              std::chrono::day(static_cast<unsigned>(number(3)))};
        if (day.ok()) return day;
    }
    refuse(option, text, "a date as 2020-07-05");
}

void Options::begin_group(std::string title, bool is_expert, std::vector<std::string> needs) {
    group_ = std::move(title);
    is_expert_ = is_expert;
    needs_ = std::move(needs);
}

void Options::add(const std::string& name, bool& variable, const std::string& description, OptionDetails details) {
    auto option = declare(name, std::move(details), description);
    option.type = "flag";
    append(std::move(option), [&variable](const Option&, const auto&) { variable = true; });
}

const Option* Options::find(const std::string& name) const {
    const auto found = std::ranges::find(options_, name, &Option::name);
    return found == options_.end() ? nullptr : &*found;
}

Option Options::declare(const std::string& name, OptionDetails details, const std::string& description) const {
    Option option{std::move(details), {}, {}, {}, {}, {}, description, group_, is_expert_, false, {}};
    option.needs.insert(option.needs.end(), needs_.begin(), needs_.end());
    const auto comma = name.find(',');
    option.name = name.substr(0, comma);
    if (comma != std::string::npos) option.short_name = name.substr(comma + 1);
    return option;
}

void Options::append(Option option, Assign assign) {
    auto own = option;
    option.assign = [own = std::move(own), assign = std::move(assign)](const auto& texts) { assign(own, texts); };
    options_.push_back(std::move(option));
}

std::string Options::help_text(bool all, std::size_t columns) const {
    constexpr std::size_t narrowest = 40;
    constexpr std::size_t widest = 120;
    const auto width = static_cast<unsigned>(std::clamp(columns, narrowest, widest));
    std::ostringstream text;
    for (std::size_t i = 0; i < options_.size();) {
        const auto& title = options_[i].group;
        po::options_description group(title, width, width / 2);
        bool is_empty = true;
        for (; i < options_.size() && options_[i].group == title; ++i) {
            if (options_[i].is_expert && !all) continue;
            add_to(group, options_[i]);
            is_empty = false;
        }
        if (!is_empty) text << group << "\n";
    }
    return text.str();
}

std::string Options::list_text() const {
    constexpr const char* file_kinds[] = {"value", "input", "output"};
    std::string text;
    for (const auto& option : options_) {
        const auto* kind = option.type == "flag" ? "flag" : file_kinds[static_cast<std::size_t>(option.file)];
        text +=
            fmt::format("--{}\t{}\t{}\t{}\t{}\n", option.name, option.short_name.empty() ? "" : "-" + option.short_name,
                        kind, value_text(option), one_line(option.description));
    }
    return text;
}

nlohmann::ordered_json Options::json() const {
    constexpr const char* roles[] = {nullptr, "input", "output"};
    auto list = nlohmann::ordered_json::array();
    for (const auto& option : options_) {
        nlohmann::ordered_json json{{"name", option.name}, {"short", option.short_name}, {"type", option.type}};
        json["value"] = option.value;
        json["unit"] = option.unit;
        json["min"] = std::isfinite(option.min) ? nlohmann::ordered_json(option.min) : nullptr;
        json["min_is_excluded"] = option.above_min;
        json["max"] = std::isfinite(option.max) ? nlohmann::ordered_json(option.max) : nullptr;
        json["max_is_excluded"] = option.below_max;
        json["choices"] = option.choices;
        json["default"] = option.default_text;
        const auto* role = roles[static_cast<std::size_t>(option.file)];
        json["file"] = role == nullptr ? nlohmann::ordered_json(nullptr) : nlohmann::ordered_json(role);
        json["repeatable"] = option.is_repeatable;
        json["needs"] = option.needs;
        json["excludes"] = option.excludes;
        json["group"] = option.group;
        json["expert"] = option.is_expert;
        json["description"] = option.description;
        list.push_back(std::move(json));
    }
    return list;
}

Options::Given Options::parse(int argc, char** argv) const {
    po::options_description known;
    for (const auto& option : options_) {
        add_to(known, option);
        if (!option.old_name.empty()) known.add_options()(option.old_name.c_str(), semantic_of(option), "");
    }
    known.add_options()(inputs_name, po::value<std::vector<std::string>>());
    po::positional_options_description positional;
    positional.add(inputs_name, -1);
    const int style = po::command_line_style::unix_style & ~po::command_line_style::allow_guessing;
    po::variables_map values;
    try {
        po::store(po::command_line_parser(argc, argv).options(known).positional(positional).style(style).run(), values);
    } catch (const po::unknown_option& error) {
        refuse_unknown_option(error.get_option_name(), error.what(), options_);
    }
    Given given;
    for (const auto& option : options_)
        if (auto texts = texts_of(values, option); !texts.empty())
            given.options.emplace_back(option.name, std::move(texts));
    if (values.count(inputs_name) > 0) given.inputs = values[inputs_name].as<std::vector<std::string>>();
    return given;
}

void Options::assign(const Given& given) const {
    const auto is_given = [&](const std::string& name) {
        return std::ranges::find(given.options, name, [](const auto& entry) { return entry.first; }) !=
               given.options.end();
    };
    for (const auto& [name, texts] : given.options) {
        const auto& option = *find(name);
        if (!option.needs.empty() && std::ranges::none_of(option.needs, is_given))
            throw UsageError(fmt::format("--{} goes with --{}", name, fmt::join(option.needs, " or --")));
        for (const auto& other : option.excludes)
            if (is_given(other))
                throw UsageError(fmt::format("--{} and --{} exclude each other: give one of them", name, other));
        option.assign(texts);
    }
    for (const auto& rule : rules_) rule();
}

}  // namespace flightwatt::cli
