#pragma once

#include "base/csv.h"
#include "base/text_table.h"
#include "record/json_type.h"

#include <algorithm>
#include <functional>
#include <initializer_list>
#include <iterator>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

/// The fields of a record are listed once, by `Fields<R> record_fields(const R*)` in the namespace of R: JSON, its
/// schema, tables, CSV and the pages of docs/reference follow from that list.
namespace flightwatt {

/// A field without its value.
struct FieldText {
    std::string key;  ///< with its unit: "energy_wh"
    std::string description;
    std::function<Json()> schema = {};
    bool is_nullable = false;  ///< null where the record that has it is absent
    bool is_interval = false;
    bool in_json = true;
    bool is_optional = false;                      ///< without a value the key is absent instead of null
    bool is_hidden_if_empty = false;               ///< no column in a table where no record has a value
    std::optional<std::string> table_column = {};  ///< heading; of an interval two: "low Ah|high Ah"
    std::optional<std::string> csv_column = {};
    std::string digits = {};  ///< of the number in tables, as fmt has it: ".3f"
};

template <typename R>
struct Field : FieldText {
    std::function<Json(const R&)> get = {};
    std::function<void(const Json&, R&)> read = {};  ///< of members that can be read back
    std::function<bool(const R&)> is_there = {};     ///< an optional key is then written, even if null

    Field reading(std::function<void(const Json&, R&)> reader) && {
        this->read = std::move(reader);
        return std::move(*this);
    }
};

/// A column of tables; without `digits` with the decimals of the key's unit, or all. Heading: the key.
struct column {
    std::string heading = {}, digits = {};
    bool is_hidden_if_empty = false;
    void operator()(FieldText& field) const {
        field.table_column = heading.empty() ? field.key : heading;
        field.digits = digits;
        field.is_hidden_if_empty = is_hidden_if_empty;
    }
};
/// A column of tables in which a record has a value.
inline column column_if_any(std::string heading = {}, std::string digits = {}) {
    return {std::move(heading), std::move(digits), true};
}
/// A column of CSV files.
struct csv_column {
    std::string heading = {};
    void operator()(FieldText& field) const { field.csv_column = heading.empty() ? field.key : heading; }
};
struct optional_key {
    void operator()(FieldText& field) const { field.is_optional = true; }
};
struct not_in_json {
    void operator()(FieldText& field) const { field.in_json = false; }
};

/// The list of a record's fields, made once.
template <Record R>
const Fields<R>& fields_of() {
    static const Fields<R> fields = record_fields(static_cast<const R*>(nullptr));
    return fields;
}

namespace record_detail {

template <typename T>
struct Getter;
template <typename C, typename T, typename R>
struct Getter<T (C::*)(const R&) const> {
    using Owner = R;
    using Value = std::remove_cvref_t<T>;
};

template <typename R, typename T>
Field<R> make_field(const std::string& key, const std::string& description, std::function<Json(const R&)> get,
                    const auto&... changes) {
    Field<R> made;
    made.key = key;
    made.description = description;
    made.schema = &JsonType<T>::schema;
    made.is_interval = std::is_same_v<T, Interval> || std::is_same_v<T, std::optional<Interval>>;
    made.get = std::move(get);
    (changes(made), ...);
    return made;
}

/// `step` (a member, or a function) of a value, of what it points to or, where it is there, of what it holds.
auto follow(const auto& value, const auto& step) {
    using T = std::remove_cvref_t<decltype(value)>;
    if constexpr (std::is_pointer_v<T>)
        return std::invoke(step, *value);
    else if constexpr (requires { *value; })  // std::optional and smart pointers
        return value ? std::optional(std::invoke(step, *value)) : std::nullopt;
    else
        return std::invoke(step, value);
}
auto follow(const auto& value, const auto& step, const auto& next, const auto&... more) {
    return follow(follow(value, step), next, more...);
}

}  // namespace record_detail

/// The value at the end of a path of members and functions: at(&Flight::resistance, &Resistance::value_ohm).
template <typename R, typename T>
auto at(T R::*first, auto... more) {
    return [=](const R& record) {
        if constexpr (sizeof...(more) == 0)
            return record.*first;
        else
            return record_detail::follow(record.*first, more...);
    };
}

/// A field that is a member of the record.
template <typename R, typename T>
Field<R> field(const std::string& key, T R::*member, const std::string& description = {}, const auto&... changes) {
    auto made = record_detail::make_field<R, T>(
        key, description, [member](const R& record) { return JsonType<T>::write(record.*member); }, changes...);
    if constexpr (JsonType<T>::reads)
        made.read = [member](const Json& json, R& record) { JsonType<T>::read(json, record.*member); };
    return made;
}

/// A field that `get` computes from the record.
template <typename F>
requires std::is_class_v<F>
auto field(const std::string& key, F get, const std::string& description = {}, const auto&... changes) {
    using Getter = record_detail::Getter<decltype(&F::operator())>;
    using R = typename Getter::Owner;
    using T = typename Getter::Value;
    return record_detail::make_field<R, T>(
        key, description, [get](const R& record) { return JsonType<T>::write(get(record)); }, changes...);
}

template <typename R, typename T>
auto field(const std::string& key, T (*get)(const R&), const std::string& description = {}, const auto&... changes) {
    return field(
        key, [get](const R& record) { return get(record); }, description, changes...);
}

/// The fields of a record within the record as fields of its own. `get` returns a pointer to it; where that is nullptr
/// they have no value.
template <typename F>
auto embedded(F get, std::initializer_list<std::string_view> without = {}) {
    using Getter = record_detail::Getter<decltype(&F::operator())>;
    using R = typename Getter::Owner;
    using S = std::remove_cv_t<std::remove_pointer_t<typename Getter::Value>>;
    Fields<R> fields;
    for (const auto& inner : fields_of<S>()) {
        if (std::ranges::find(without, inner.key) != without.end()) continue;
        auto& field = fields.emplace_back();
        static_cast<FieldText&>(field) = inner;
        field.get = [get, value = inner.get](const R& record) {
            const S* part = get(record);
            return part == nullptr ? Json() : value(*part);
        };
        if (!inner.is_there) continue;
        field.is_there = [get, is_there = inner.is_there](const R& record) {
            const S* part = get(record);
            return part != nullptr && is_there(*part);
        };
    }
    return fields;
}

/// The same, with null for each key where there is no such record.
template <typename F>
auto embedded_or_null(F get) {
    auto fields = embedded(get);
    for (auto& field : fields) field.is_nullable = true;
    return fields;
}

/// The same of a member.
template <typename R, typename S>
Fields<R> embedded(S R::*member, std::initializer_list<std::string_view> without = {}) {
    auto fields = embedded([member](const R& record) { return &(record.*member); }, without);
    for (auto& field : fields) {
        const auto inner = std::ranges::find(fields_of<S>(), field.key, &FieldText::key);
        if (inner->read)
            field.read = [member, read = inner->read](const Json& json, R& record) { read(json, record.*member); };
    }
    return fields;
}

/// The same; the keys are absent from JSON where there is no such record.
template <typename F>
auto embedded_if_any(F get, std::initializer_list<std::string_view> without = {}) {
    auto fields = embedded(get, without);
    for (auto& field : fields) {
        if (field.is_optional) continue;  // absent for reasons of its own
        field.is_optional = true;
        field.is_there = [get](const auto& record) { return get(record) != nullptr; };
    }
    return fields;
}

/// The same of a member that may be absent.
template <typename R, typename S>
Fields<R> embedded_if_any(std::optional<S> R::*member, std::initializer_list<std::string_view> without = {}) {
    return embedded_if_any(
        [member](const R& record) -> const S* { return record.*member ? &*(record.*member) : nullptr; }, without);
}

/// A list of single fields and of embedded ones.
template <typename R, typename... Parts>
Fields<R> list_fields(Parts... parts) {
    Fields<R> fields;
    const auto add = [&]<typename Part>(Part part) {
        if constexpr (std::is_same_v<Part, Field<R>>)
            fields.push_back(std::move(part));
        else
            std::ranges::move(part, std::back_inserter(fields));
    };
    (add(std::move(parts)), ...);
    return fields;
}

template <typename R>
Json fields_json(const Fields<R>& fields, const R& record) {
    auto json = Json::object();
    for (const auto& field : fields) {
        if (!field.in_json) continue;
        auto value = field.get(record);
        if (!field.is_optional || !value.is_null() || (field.is_there && field.is_there(record)))
            json[field.key] = std::move(value);
    }
    return json;
}

template <Record R>
Json record_json(const R& record) {
    return fields_json(fields_of<R>(), record);
}

/// Reads the fields that are members. Throws std::exception for a missing one or one of another type.
template <Record R>
void read_record(const Json& json, R& record) {
    for (const auto& field : fields_of<R>())
        if (field.in_json && field.read && (!field.is_optional || json.contains(field.key)))
            field.read(json.at(field.key), record);
}

Json object_schema(const std::vector<const FieldText*>& fields);

/// JSON Schema (draft 2020-12) of these fields, with descriptions, units and columns as annotations.
template <typename R>
Json fields_schema(const Fields<R>& fields) {
    std::vector<const FieldText*> texts;
    for (const auto& field : fields) texts.push_back(&field);
    return object_schema(texts);
}

template <Record R>
Json record_schema() {
    return fields_schema(fields_of<R>());
}

/// An object of some of the record's fields.
template <typename R>
Field<R> object(const std::string& key, const std::string& description, Fields<R> fields, const auto&... changes) {
    Field<R> made;
    made.key = key;
    made.description = description;
    made.schema = [fields] { return fields_schema(fields); };
    made.get = [fields = std::move(fields)](const R& record) { return fields_json(fields, record); };
    (changes(made), ...);
    return made;
}

/// The values of some records, a row each, of the fields that are columns.
struct RecordRows {
    std::vector<const FieldText*> fields = {};
    std::vector<std::vector<Json>> rows = {};
};

template <Record R>
RecordRows rows_of(const auto& records, std::optional<std::string> FieldText::*column) {
    RecordRows all;
    std::vector<const Field<R>*> shown;
    for (const auto& field : fields_of<R>())
        if (field.*column) shown.push_back(&field);
    all.fields.assign(shown.begin(), shown.end());
    for (const R& record : records) {
        auto& row = all.rows.emplace_back();
        for (const auto* field : shown) row.push_back(field->get(record));
    }
    return all;
}

TextTable text_table(const RecordRows& records);
CsvWriter csv_header(const RecordRows& records, int digits);
void add_csv_rows(const RecordRows& records, CsvWriter& csv);

/// A row a record: '-' for null, "yes" and "no" for true and false.
template <Record R>
TextTable table_of(const std::vector<R>& records) {
    return text_table(rows_of<R>(records, &FieldText::table_column));
}

/// A row a record, with that many significant digits (0: all); null is an empty cell.
template <Record R>
std::string csv_of(const std::vector<R>& records, int digits = 0) {
    const auto rows = rows_of<R>(records, &FieldText::csv_column);
    auto csv = csv_header(rows, digits);
    add_csv_rows(rows, csv);
    return csv.text();
}

/// A line a known number, text or flag of a record's JSON, "idle current mean: 0.30 A"; its lists are left out.
std::string values_text(const Json& record, const std::string& prefix = {});

/// The unit that a key or a column ends with, and the decimals that people read; nullptr for none.
struct KeyUnit {
    std::string_view suffix;
    std::string_view unit;
    int decimals;
};
const KeyUnit* unit_of_key(std::string_view key);

}  // namespace flightwatt
