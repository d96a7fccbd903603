#include "base/toml_reader.h"

#include "base/atomic_file.h"
#include "base/text.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <toml++/toml.h>

namespace flightwatt {
namespace {

std::size_t edit_distance(std::string_view a, std::string_view b) {
    std::vector<std::size_t> row(b.size() + 1);
    std::iota(row.begin(), row.end(), std::size_t{0});
    for (std::size_t i = 1; i <= a.size(); ++i) {
        std::size_t diagonal = row[0];
        row[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const auto substituted = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
            diagonal = row[j];
            row[j] = std::min({row[j] + 1, row[j - 1] + 1, substituted});
        }
    }
    return row.back();
}

/// The shortest name that contains the word, one that begins with it before others; empty if none does.
std::string name_with_part(std::string_view word, const std::vector<std::string>& known) {
    constexpr std::size_t min_part = 3;
    if (word.size() < min_part) return {};
    const auto rank = [&](const std::string& name) { return std::pair(!name.starts_with(word), name.size()); };
    const std::string* best = nullptr;
    for (const auto& name : known)
        if (name.find(word) != std::string::npos && (best == nullptr || rank(name) < rank(*best))) best = &name;
    return best == nullptr ? "" : *best;
}

}  // namespace

std::string nearest_word(std::string_view word, const std::vector<std::string>& known) {
    constexpr std::size_t max_word = 100;
    std::string nearest;
    if (word.size() > max_word) return nearest;
    if (nearest = name_with_part(word, known); !nearest.empty()) return nearest;
    std::size_t best = std::max<std::size_t>(2, word.size() / 3) + 1;
    for (const auto& candidate : known) {
        if (candidate.size() > max_word) continue;
        const auto distance = edit_distance(word, candidate);
        if (distance < best) {
            best = distance;
            nearest = candidate;
        }
    }
    return nearest;
}

namespace {

/// The unit that a name ends with, in small letters: "ft" of "altitude_ft", "m/s" of "climb_m_per_s"; empty: none.
std::string unit_in_name(std::string_view name) {
    static constexpr auto units = std::to_array<std::string_view>(
        {"m",  "km",  "cm",  "mm",   "ft", "feet", "s",   "ms",  "us",  "min",     "h",   "v",     "mv",  "a",   "ma",
         "ah", "mah", "w",   "kw",   "mw", "wh",   "mwh", "kwh", "j",   "kj",      "kg",  "g",     "deg", "rad", "c",
         "f",  "k",   "m/s", "cm/s", "kt", "km/h", "kmh", "kph", "mph", "percent", "kts", "knots", "ohm", "mohm"});
    std::string text(name);
    std::ranges::transform(text, text.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    if (const auto per = text.find("_per_"); per != std::string::npos) text.replace(per, 5, "/");
    for (const auto* speed : {"_m_s", "_cm_s", "_km_h"})
        if (text.ends_with(speed)) text[text.size() - 2] = '/';
    const auto at = text.rfind('_');
    const auto unit = at == std::string::npos ? std::string() : text.substr(at + 1);
    return std::ranges::find(units, unit) == units.end() ? std::string() : unit;
}

/// "did you mean 'altitude_m'?", and that its values have another unit, where the names have them.
std::string meant_text(std::string_view word, const std::string& near) {
    const auto unit = unit_in_name(word);
    const auto meant = unit_in_name(near);
    const bool is_speed = unit == "ms" && meant == "m/s";  // so written, too
    const bool is_other = !unit.empty() && !meant.empty() && unit != meant && !is_speed;
    return fmt::format("did you mean '{}'?", near) +
           (is_other ? fmt::format(" its values are in {}, not in {}: convert them", meant, unit) : "");
}

}  // namespace

std::string meant_or(std::string_view word, const std::vector<std::string>& known, std::string_view otherwise) {
    const auto near = nearest_word(word, known);
    return near.empty() ? std::string(otherwise) : meant_text(word, near);
}

namespace {

Location location_of(const std::string& file, const toml::source_region& region) {
    return {file, region.begin.line, region.begin.column};
}

/// `example` is a value of the expected type.
[[noreturn]] void wrong_type(const std::string& file, const toml::node& node, std::string_view key,
                             std::string_view expected, std::string_view example = "") {
    std::ostringstream type;
    type << node.type();
    throw InputError(location_of(file, node.source()),
                     fmt::format("'{}' is a TOML {}, expected {}", key, type.str(), expected),
                     example.empty() ? "" : fmt::format("write it as {} = {}", key, example));
}

double finite_number(const std::string& file, const toml::node& node, std::string_view key) {
    const auto value = node.is_number() ? node.value<double>() : std::nullopt;
    if (!value || !std::isfinite(*value)) wrong_type(file, node, key, "a finite number", "12.5");
    return *value;
}

std::string text_of(const std::string& file, const toml::node& node, std::string_view key) {
    if (!node.is_string()) wrong_type(file, node, key, "a string", "\"text\"");
    return *node.value<std::string>();
}

/// No file of ours nests deeper than five. The parser limits arrays and inline tables; keys of some ten thousand parts
/// would end the program (its stack).
constexpr std::size_t deepest_nesting = 50;
/// A file in memory takes up to some hundred times its size. A mission or model has some 10 kB.
constexpr std::size_t max_toml_bytes = 8'000'000;

/// Where a key has more than `most` dots; npos: nowhere. Comments are skipped, texts of dots alone are not.
std::size_t find_deeper_key(std::string_view text, std::size_t most) {
    constexpr std::string_view ends_of_keys = "\n,[{";
    std::size_t dots = 0;
    for (std::size_t at = 0; at < text.size(); ++at) {
        if (text.substr(at).starts_with("# ")) at = std::min(text.find('\n', at), text.size() - 1);
        if (ends_of_keys.find(text[at]) != std::string_view::npos) dots = 0;
        if (text[at] == '.' && ++dots > most) return at;
    }
    return std::string_view::npos;
}

void refuse_monsters(std::string_view text, const std::string& file) {
    if (text.size() > max_toml_bytes) {
        throw InputError({file}, fmt::format("holds more than {} MB of TOML", max_toml_bytes / 1'000'000),
                         "is it the file that was meant?");
    }
    const auto at = find_deeper_key(text, deepest_nesting);
    if (at == std::string_view::npos) return;
    throw InputError({file, line_of_offset(text, at), at - (text.substr(0, at).rfind('\n') + 1) + 1},
                     fmt::format("keys are nested more than {} levels deep", deepest_nesting));
}

/// Other words for keys.
std::string known_synonym(std::string_view word, const std::vector<std::string>& known) {
    constexpr std::array<std::pair<std::string_view, std::string_view>, 5> synonyms{{{"model", "mechanical"},
                                                                                     {"aircraft", "mechanical"},
                                                                                     {"pack", "battery"},
                                                                                     {"software", "components"},
                                                                                     {"component", "components"}}};
    for (const auto& [other, key] : synonyms)
        if (word == other && std::ranges::find(known, key) != known.end()) return std::string(key);
    return nearest_word(word, known);
}

}  // namespace

struct UnknownKey {
    Location where;
    std::string key;
    std::string near;   ///< what was probably meant; may be empty
    std::string table;  ///< its path in the file
    std::vector<std::string> known;
};

namespace {

[[noreturn]] void refuse_keys(const std::vector<UnknownKey>& unknown) {
    const auto& first = unknown.front();
    std::vector<std::string> names;
    std::map<std::string, std::string> known_keys;
    for (const auto& [where, key, near, table, known] : unknown) {
        const auto place = fmt::format(" in line {}", where.line);
        const auto meant = near.empty() ? "" : fmt::format(" ({})", meant_text(key, near));
        names.push_back(fmt::format("'{}'{}{}", truncated(key), place, meant));
        if (near.empty())
            known_keys[table] = fmt::format("known keys{}: {}", table.empty() ? "" : fmt::format(" of [{}]", table),
                                            fmt::join(known, ", "));
    }
    std::vector<std::string> hints;
    hints.reserve(known_keys.size());
    for (const auto& [table, hint] : known_keys) hints.push_back(hint);
    if (unknown.size() > 1)
        throw InputError(first.where, fmt::format("{} unknown keys: {}", unknown.size(), fmt::join(names, ", ")),
                         fmt::format("{}", fmt::join(hints, "; ")));
    throw InputError(first.where, fmt::format("unknown key '{}'", first.key),
                     first.near.empty() ? hints.front() : meant_text(first.key, first.near));
}

/// A remedy for errors of the TOML parser, which names the grammar alone.
std::string remedy_of_syntax(std::string_view description) {
    const auto has = [&](std::string_view part) { return description.find(part) != std::string_view::npos; };
    if (has("could not determine value type")) return "texts are in quotes: name = \"text\"";
    if (has("redefine")) return "it is there twice: remove one";
    return has("expected a comment or newline, saw") || has("value-terminator")
               ? "one value a line; decimals have a point: 12.5"
               : "expected lines such as name = 12.5 and name = \"text\"";
}

std::set<RequestedKey>* recorded_keys = nullptr;

std::string path_below(const std::string& path, std::string_view key) {
    return path.empty() ? std::string(key) : path + "." + std::string(key);
}

std::string describe(NumberRange range) {
    if (std::isinf(range.low)) return fmt::format("at most {}", range.high);
    if (std::isinf(range.high)) {
        return range.low_excluded ? fmt::format("more than {}", range.low) : fmt::format("{} or more", range.low);
    }
    return range.low_excluded ? fmt::format("more than {} and at most {}", range.low, range.high)
                              : fmt::format("{} to {}", range.low, range.high);
}

}  // namespace

void record_requested_keys(std::set<RequestedKey>* asked) { recorded_keys = asked; }

struct TomlTable::File {
    toml::table table;
    bool collects = false;
    std::vector<UnknownKey> unknown = {};
};

TomlTable::TomlTable(std::shared_ptr<File> root, const toml::table* table, std::string file, std::string path)
    : root_(std::move(root)),
      table_(table),
      file_(std::move(file)),
      path_(std::move(path)),
      asked_(std::make_shared<std::set<std::string, std::less<>>>()) {}

TomlTable parse_toml(std::string_view text, const std::string& file, FileKind expected) {
    if (expected != FileKind::unknown) require_kind(text, expected, file);
    refuse_monsters(text, file);
    try {
        auto root = std::make_shared<TomlTable::File>();
        root->table = toml::parse(text, file);
        const auto* table = &root->table;
        return {std::move(root), table, file, ""};
    } catch (const toml::parse_error& error) {
        throw InputError(location_of(file, error.source()), fmt::format("is not TOML: {}", error.description()),
                         remedy_of_syntax(error.description()));
    }
}

TomlTable read_toml(const std::filesystem::path& path, FileKind expected) {
    return parse_toml(read_file(path), path.string(), expected);
}

void TomlTable::mark_used(std::string_view key) const {
    asked_->emplace(key);
    if (recorded_keys != nullptr) recorded_keys->insert({file_, path_, std::string(key)});
}

const toml::node* TomlTable::find(std::string_view key) const {
    mark_used(key);
    return table_->get(key);
}

const toml::node& TomlTable::require(std::string_view key) const {
    if (const auto* node = find(key)) return *node;
    // A misspelt key is more probable than a forgotten one.
    std::vector<std::string> unknown;
    for (const auto& name : keys())
        if (!asked_->contains(name)) unknown.push_back(name);
    const auto near = nearest_word(key, unknown);
    throw InputError(near.empty() ? where() : where(near), fmt::format("has no key '{}'", key),
                     near.empty() ? "" : fmt::format("'{}' is here; was that meant?", near));
}

bool TomlTable::has(std::string_view key) const { return find(key) != nullptr; }

double TomlTable::number(std::string_view key) const { return finite_number(file_, require(key), key); }

std::optional<double> TomlTable::optional_number(std::string_view key) const {
    return has(key) ? std::optional(number(key)) : std::nullopt;
}

std::string TomlTable::string(std::string_view key) const { return text_of(file_, require(key), key); }

std::optional<std::string> TomlTable::optional_string(std::string_view key) const {
    return has(key) ? std::optional(string(key)) : std::nullopt;
}

std::optional<bool> TomlTable::optional_boolean(std::string_view key) const {
    const auto* node = find(key);
    if (node == nullptr) return std::nullopt;
    if (!node->is_boolean()) wrong_type(file_, *node, key, "true or false", "true");
    return node->value<bool>();
}

std::vector<double> TomlTable::numbers(std::string_view key) const {
    const auto& node = require(key);
    if (!node.is_array()) wrong_type(file_, node, key, "an array of numbers", "[1, 2.5]");
    std::vector<double> values;
    for (const auto& element : *node.as_array()) values.push_back(finite_number(file_, element, key));
    return values;
}

std::vector<std::string> TomlTable::strings(std::string_view key) const {
    const auto& node = require(key);
    if (!node.is_array()) wrong_type(file_, node, key, "an array of strings", "[\"text\"]");
    std::vector<std::string> values;
    for (const auto& element : *node.as_array()) values.push_back(text_of(file_, element, key));
    return values;
}

TomlTable TomlTable::table(std::string_view key) const {
    const auto& node = require(key);
    if (!node.is_table()) wrong_type(file_, node, key, "a table", "{ ... }");
    return {root_, node.as_table(), file_, path_below(path_, key)};
}

std::optional<TomlTable> TomlTable::optional_table(std::string_view key, std::string_view example) const {
    const auto* node = find(key);
    if (node != nullptr && !node->is_table() && !example.empty()) wrong_type(file_, *node, key, "a table", example);
    return node != nullptr ? std::optional(table(key)) : std::nullopt;
}

std::vector<TomlTable> TomlTable::tables(std::string_view key) const {
    const auto* node = find(key);
    if (node == nullptr) return {};
    if (!node->is_array()) wrong_type(file_, *node, key, "an array of tables ([[...]])");
    std::vector<TomlTable> result;
    for (const auto& element : *node->as_array()) {
        if (!element.is_table()) wrong_type(file_, element, key, "a table");
        result.push_back(TomlTable(root_, element.as_table(), file_, path_below(path_, key)));
    }
    return result;
}

std::vector<std::string> TomlTable::keys() const {
    std::vector<std::pair<toml::source_position, std::string>> placed;
    for (const auto& [key, node] : *table_) placed.emplace_back(key.source().begin, std::string(key.str()));
    std::sort(placed.begin(), placed.end());
    std::vector<std::string> names;
    names.reserve(placed.size());
    for (auto& [position, name] : placed) names.push_back(std::move(name));
    return names;
}

bool TomlTable::is_number(std::string_view key) const {
    const auto* node = table_->get(key);
    return node != nullptr && node->is_number();
}

bool TomlTable::is_table(std::string_view key) const {
    const auto* node = table_->get(key);
    return node != nullptr && node->is_table();
}

void TomlTable::refuse_unknown_keys() const {
    const std::vector<std::string> known(asked_->begin(), asked_->end());
    std::vector<UnknownKey> unknown;
    for (const auto& name : keys())
        if (!asked_->contains(name)) unknown.push_back({where(name), name, known_synonym(name, known), path_, known});
    if (unknown.empty()) return;
    if (!root_->collects) refuse_keys(unknown);
    for (auto& key : unknown) {
        const auto is_here = [&](const UnknownKey& other) {
            return std::pair(other.where.line, other.where.column) == std::pair(key.where.line, key.where.column);
        };
        if (std::ranges::none_of(root_->unknown, is_here)) root_->unknown.push_back(std::move(key));  // read once more
    }
}

void TomlTable::collect_unknown_keys(const std::function<void()>& read) const {
    root_->collects = true;
    try {
        read();
    } catch (const std::exception&) {
        if (root_->unknown.empty()) throw;
    }
    root_->collects = false;
    if (!root_->unknown.empty()) refuse_keys(root_->unknown);
}

void TomlTable::refuse_keys_except(std::initializer_list<std::string_view> known) const {
    for (const auto key : known) mark_used(key);
    refuse_unknown_keys();
}

Location TomlTable::where() const { return location_of(file_, table_->source()); }

Location TomlTable::where(std::string_view key) const {
    for (const auto& [name, node] : *table_)
        if (name.str() == key) return location_of(file_, name.source());
    return where();
}

void require_in(NumberRange range, double value, std::string_view name, const Location& where, std::string_view hint) {
    const bool above_low = range.low_excluded ? value > range.low : value >= range.low;
    if (above_low && value <= range.high) return;
    throw InputError(where, fmt::format("{} = {}, expected {}", name, value, describe(range)), std::string(hint));
}

double number_in(NumberRange range, const TomlTable& table, std::string_view key, std::string_view hint) {
    const double value = table.number(key);
    require_in(range, value, key, table.where(key), hint);
    return value;
}

std::optional<double> optional_number_in(NumberRange range, const TomlTable& table, std::string_view key,
                                         std::string_view hint) {
    const auto value = table.optional_number(key);
    if (value) require_in(range, *value, key, table.where(key), hint);
    return value;
}

double number_in_or(NumberRange range, const TomlTable& table, std::string_view key, double default_value) {
    return optional_number_in(range, table, key).value_or(default_value);
}

std::uint64_t count_in(const TomlTable& table, std::string_view key, std::uint64_t least) {
    constexpr double largest_exact = 9007199254740992.0;  // 2^53: beyond, not every whole number is a double
    const double value = table.number(key);
    if (value != std::floor(value) || value > largest_exact) {
        throw InputError(table.where(key), fmt::format("{} = {}, expected a whole number", key, value));
    }
    if (value < static_cast<double>(least)) {
        throw InputError(table.where(key),
                         fmt::format("{} = {}, expected a whole number, {} or more", key, value, least));
    }
    return static_cast<std::uint64_t>(value);
}

std::uint64_t count_in_or(const TomlTable& table, std::string_view key, std::uint64_t least,
                          std::uint64_t default_value) {
    return table.has(key) ? count_in(table, key, least) : default_value;
}

std::string format_line() { return fmt::format("format = {}\n", format_version); }

void require_known_format(const TomlTable& root) {
    const double format = root.optional_number("format").value_or(format_version);
    if (format < 1.0 || format != std::floor(format)) {
        throw InputError(root.where("format"), fmt::format("format = {} is no version of a format", format),
                         fmt::format("expected a whole number from 1 to {}", format_version));
    }
    if (format <= format_version) return;
    throw InputError(
        root.where("format"),
        fmt::format("format = {} is newer than this program, which reads formats up to {}", format, format_version),
        "use a newer FlightWatt, or write the file with this one");
}

}  // namespace flightwatt
