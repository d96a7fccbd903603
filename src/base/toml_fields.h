#pragma once

#include "base/text.h"
#include "base/toml_reader.h"

#include <cstddef>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/ranges.h>

namespace flightwatt {

/// The layout of a table that is written.
enum class TomlLayout {
    inline_table,  ///< key = { a = 1.0, b = 2.0 }
    section        ///< [path.key] and a line each
};

/// The keys of one table that is read or written. A record names each of its fields once, with one of these calls,
/// which assigns the field while reading, and writes it otherwise. Reading throws InputError with its location.
class TomlFields {
  public:
    explicit TomlFields(const TomlTable& table) : table_(&table) {}
    /// Writes the table of that path, "cruise.errors"; empty: the whole file.
    explicit TomlFields(std::string path) : path_(std::move(path)) {}

    /// The table that is read; nullptr while writing.
    const TomlTable* source() const { return table_; }
    /// While writing: a line as it is.
    void line(std::string_view text) {
        if (table_ == nullptr) lines_.emplace_back(text);
    }
    std::string lines() const { return fmt::format("{}", fmt::join(lines_, "\n")); }
    /// Whether a key that may be missing is to be listed: it is in the file, or, while writing, its field is set.
    bool has(std::string_view key, bool is_set) const { return table_ != nullptr ? table_->has(key) : is_set; }

    void real(std::string_view key, double& value, NumberRange range = {}, std::string_view hint = "") {
        if (table_ == nullptr) return write(key, toml_real(value));
        value = number_in(range, *table_, key, hint);
    }
    void optional_real(std::string_view key, std::optional<double>& value, NumberRange range = {}) {
        if (has(key, value.has_value())) real(key, value ? *value : value.emplace(), range);
    }
    void reals(std::string_view key, std::vector<double>& values) {
        if (table_ == nullptr) return write(key, toml_reals(values));
        values = table_->numbers(key);
    }
    void text(std::string_view key, std::string& value) {
        if (table_ == nullptr) return write(key, toml_string(value));
        value = table_->string(key);
    }
    /// A text that is written unless it is empty.
    void optional_text(std::string_view key, std::string& value) {
        if (has(key, !value.empty())) text(key, value);
    }
    void texts(std::string_view key, std::vector<std::string>& values) {
        if (table_ == nullptr) return write(key, toml_strings(values));
        values = table_->strings(key);
    }
    void count(std::string_view key, std::size_t& value, std::size_t least = 0) {
        if (table_ == nullptr) return write(key, fmt::format("{}", value));
        value = count_in(*table_, key, least);
    }
    void counts(std::string_view key, std::vector<std::size_t>& values) {
        if (table_ == nullptr) return write(key, fmt::format("[{}]", fmt::join(values, ", ")));
        for (const double value : table_->numbers(key)) values.push_back(static_cast<std::size_t>(value));
    }
    void flag(std::string_view key, bool& value) {
        if (table_ == nullptr) return write(key, fmt::format("{}", value));
        value = table_->optional_boolean(key).value_or(false);
    }
    /// A flag that is written if it is set.
    void optional_flag(std::string_view key, bool& value) {
        if (has(key, value)) flag(key, value);
    }
    /// One of `values`, which is written as its to_string.
    template <typename Value, typename Values = std::initializer_list<Value>>
    void choice(std::string_view key, Value& value, const Values& values) {
        if (table_ == nullptr) return write(key, toml_string(to_string(value)));
        const auto name = table_->string(key);
        std::vector<std::string_view> names;
        for (const auto one : values) {
            names.push_back(to_string(one));
            if (names.back() != name) continue;
            value = one;
            return;
        }
        throw InputError(table_->where(key), fmt::format("there is no {} '{}'", key, truncated(name)),
                         fmt::format("it is one of {}", fmt::join(names, ", ")));
    }

    template <typename Record, typename List>
    void table(std::string_view key, Record& record, const List& list, TomlLayout layout = TomlLayout::inline_table) {
        if (table_ != nullptr) return read(table_->table(key), record, list);
        TomlFields fields(path_of(key));
        list(fields, record);
        if (layout == TomlLayout::section) line(fmt::format("[{}]\n{}", fields.path_, fields.lines()));
        if (layout == TomlLayout::inline_table) write(key, fmt::format("{{ {} }}", fmt::join(fields.lines_, ", ")));
    }
    template <typename Record, typename List>
    void optional_table(std::string_view key, std::optional<Record>& record, const List& list,
                        TomlLayout layout = TomlLayout::inline_table) {
        if (has(key, record.has_value())) table(key, record ? *record : record.emplace(), list, layout);
    }
    /// An array of tables, [[path.key]], `before` each an empty line or none.
    template <typename Record, typename List>
    void tables(std::string_view key, std::vector<Record>& records, const List& list, std::string_view before = "\n") {
        if (table_ != nullptr) {
            for (const auto& element : table_->tables(key)) read(element, records.emplace_back(), list);
            return;
        }
        for (auto& record : records) {
            TomlFields fields(path_of(key));
            list(fields, record);
            line(fmt::format("{}[[{}]]\n{}", before, fields.path_, fields.lines()));
        }
    }

  private:
    template <typename Record, typename List>
    static void read(const TomlTable& table, Record& record, const List& list) {
        TomlFields fields(table);
        list(fields, record);
        table.refuse_unknown_keys();
    }
    void write(std::string_view key, std::string_view value) { line(fmt::format("{} = {}", key, value)); }
    std::string path_of(std::string_view key) const { return path_ + (path_.empty() ? "" : ".") + std::string(key); }

    const TomlTable* table_ = nullptr;
    std::string path_;
    std::vector<std::string> lines_;
};

}  // namespace flightwatt
