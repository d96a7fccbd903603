#pragma once

#include "base/error.h"
#include "base/input_file.h"

#include <compare>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <initializer_list>
#include <limits>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace toml {
inline namespace v3 {
class node;
class table;
}  // namespace v3
}  // namespace toml

namespace flightwatt {

/// One table of a TOML file, read strictly: every key that is there must be asked for, and has the type that
/// is asked for, or InputError with file, line and column. Copies are cheap and share the parsed file.
class TomlTable {
  public:
    bool has(std::string_view key) const;
    /// Finite; integers count as numbers.
    double number(std::string_view key) const;
    std::optional<double> optional_number(std::string_view key) const;
    std::string string(std::string_view key) const;
    std::optional<std::string> optional_string(std::string_view key) const;
    std::optional<bool> optional_boolean(std::string_view key) const;
    std::vector<double> numbers(std::string_view key) const;
    std::vector<std::string> strings(std::string_view key) const;
    TomlTable table(std::string_view key) const;
    /// `example` is what a table of this key holds, for the error: "{ cruise = 600 }".
    std::optional<TomlTable> optional_table(std::string_view key, std::string_view example = "") const;
    /// An array of tables; empty if the key is not there.
    std::vector<TomlTable> tables(std::string_view key) const;
    /// Every key of this table, in the order of the file.
    std::vector<std::string> keys() const;
    bool is_number(std::string_view key) const;
    bool is_table(std::string_view key) const;

    /// Throws InputError for the keys that were not read, each with the nearest one that was, or all that were.
    void refuse_unknown_keys() const;
    /// The same before any key is read, so that a misspelt key is not reported as missing.
    void refuse_keys_except(std::initializer_list<std::string_view> known) const;
    /// Calls `read`, which reads tables of this file: the unknown keys of all tables are reported together, before any
    /// other error.
    void collect_unknown_keys(const std::function<void()>& read) const;

    const std::string& file() const { return file_; }
    /// Location of this table, or of one of its keys.
    Location where() const;
    Location where(std::string_view key) const;

  private:
    struct File;
    friend TomlTable parse_toml(std::string_view text, const std::string& file, FileKind expected);
    TomlTable(std::shared_ptr<File> root, const toml::table* table, std::string file, std::string path);
    void mark_used(std::string_view key) const;

    const toml::node& require(std::string_view key) const;
    const toml::node* find(std::string_view key) const;

    std::shared_ptr<File> root_;
    const toml::table* table_;
    std::string file_;
    std::string path_;  ///< of this table in the file: "", "components.detection", "schedule"
    std::shared_ptr<std::set<std::string, std::less<>>> asked_;
};

/// A key that a reader asked a table of a file for, whether it was there or not.
struct RequestedKey {
    std::string file;
    std::string table;  ///< its path in the file; empty for the file itself
    std::string key;
    auto operator<=>(const RequestedKey&) const = default;  // NOLINT(modernize-use-nullptr): it takes the 0 of "< 0"
};

/// From now on every key that any reader asks for is put into `asked`, until this is called with nullptr. For
/// the test that holds the documents to the readers; not while several threads read.
void record_requested_keys(std::set<RequestedKey>* asked);

/// Throws InputError with line and column where the text is not TOML, and for a file of another kind than expected.
TomlTable read_toml(const std::filesystem::path& path, FileKind expected = FileKind::unknown);
TomlTable parse_toml(std::string_view text, const std::string& file, FileKind expected = FileKind::unknown);

/// The word among `known` that `word` was probably meant to be: one that contains it or has few other letters; empty
/// if none is near.
std::string nearest_word(std::string_view word, const std::vector<std::string>& known);
/// Returns "did you mean 'WORD'?" with the nearest word, or `otherwise` if none is near.
std::string meant_or(std::string_view word, const std::vector<std::string>& known, std::string_view otherwise);

/// The numbers that a key may have.
struct NumberRange {
    double low = -std::numeric_limits<double>::infinity();
    double high = std::numeric_limits<double>::infinity();
    bool low_excluded = false;
};

constexpr NumberRange at_least(double low) { return {low, std::numeric_limits<double>::infinity(), false}; }
constexpr NumberRange more_than(double low) { return {low, std::numeric_limits<double>::infinity(), true}; }
constexpr NumberRange at_most(double high) { return {-std::numeric_limits<double>::infinity(), high, false}; }
constexpr NumberRange between(double low, double high) { return {low, high, false}; }
constexpr NumberRange more_than_up_to(double low, double high) { return {low, high, true}; }

/// Throws InputError at `where`, for `name` = `value`, unless the value is in the range; NaN is not.
void require_in(NumberRange range, double value, std::string_view name, const Location& where,
                std::string_view hint = "");

double number_in(NumberRange range, const TomlTable& table, std::string_view key, std::string_view hint = "");
std::optional<double> optional_number_in(NumberRange range, const TomlTable& table, std::string_view key,
                                         std::string_view hint = "");
double number_in_or(NumberRange range, const TomlTable& table, std::string_view key, double default_value);

/// A whole number of at least `least`, and small enough that a double holds it exactly.
std::uint64_t count_in(const TomlTable& table, std::string_view key, std::uint64_t least = 0);
std::uint64_t count_in_or(const TomlTable& table, std::string_view key, std::uint64_t least,
                          std::uint64_t default_value);

/// Version of the file formats that FlightWatt writes, and the newest that it reads.
inline constexpr int format_version = 1;

/// Its line of TOML, "format = 1\n".
std::string format_line();

/// Checks `format` of a file of ours, which may be absent (files of version 0.1 have none). Throws InputError
/// for a newer or invalid format.
void require_known_format(const TomlTable& root);

}  // namespace flightwatt
