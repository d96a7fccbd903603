#include "record/record.h"

#include <array>
#include <cmath>

#include <fmt/format.h>

namespace flightwatt {
namespace {

/// Longer ones before those that they end with.
constexpr std::array<KeyUnit, 21> units{{{"_m3_per_s3", "m3/s3", 0},
                                         {"_m_per_s2", "m/s2", 2},
                                         {"_m_per_s", "m/s", 1},
                                         {"_rad_per_s", "rad/s", 4},
                                         {"_ohm_per_flight", "ohm", 5},
                                         {"_wh_per_min", "Wh/min", 3},
                                         {"_km", "Wh/km", 3},
                                         {"_percent", "%", 1},
                                         {"_mah", "mAh", 0},
                                         {"_ohm", "ohm", 4},
                                         {"_deg", "deg", 1},
                                         {"_rad", "rad", 3},
                                         {"_mv", "mV", 1},
                                         {"_ah", "Ah", 3},
                                         {"_wh", "Wh", 3},
                                         {"_w", "W", 2},
                                         {"_v", "V", 2},
                                         {"_a", "A", 2},
                                         {"_m", "m", 1},
                                         {"_s", "s", 1},
                                         {"_c", "°C", 1}}};

constexpr std::string_view interval_suffix = "_interval_95";

std::string cell_text(const Json& value, const FieldText& field) {
    if (value.is_null()) return "-";
    if (value.is_string()) return value.get<std::string>();
    if (value.is_boolean()) return value.get<bool>() ? "yes" : "no";
    if (!value.is_number_float()) return value.dump();
    if (!std::isfinite(value.get<double>())) return "-";
    const auto* unit = unit_of_key(field.key);
    const auto digits = !field.digits.empty() ? field.digits
                        : unit != nullptr     ? fmt::format(".{}f", unit->decimals)
                                              : std::string();
    return fmt::format(fmt::runtime(fmt::format("{{:{}}}", digits)), value.get<double>());
}

std::string csv_text(const Json& value, const CsvWriter& csv) {
    if (value.is_null()) return "";
    if (value.is_string()) return csv_cell(value.get_ref<const std::string&>());
    return value.is_number_float() ? csv.cell(value.get<double>()) : value.dump();
}

/// The names of a field's columns: of an interval the two on the sides of '|', or with "low" and "high" added.
std::vector<std::string> names_of(const FieldText& field, const std::string& column, std::string_view joint) {
    if (!field.is_interval) return {column};
    if (const auto bar = column.find('|'); bar != std::string::npos)
        return {column.substr(0, bar), column.substr(bar + 1)};
    return {fmt::format("{}{}low", column, joint), fmt::format("{}{}high", column, joint)};
}

/// Calls `use` with the value, or with both ends of an interval.
void for_each_cell(const FieldText& field, const Json& value, const auto& use) {
    if (!field.is_interval) return use(value);
    for (const auto* end : {"low", "high"}) use(value.is_null() ? Json() : value.at(end));
}

}  // namespace

const KeyUnit* unit_of_key(std::string_view key) {
    if (key.ends_with(interval_suffix)) key.remove_suffix(interval_suffix.size());
    const auto* const found =
        std::ranges::find_if(units, [&](const KeyUnit& unit) { return key.ends_with(unit.suffix); });
    return found == units.end() ? nullptr : found;
}

Json nullable(Json schema) {
    if (!schema.contains("type")) return schema.empty() ? schema : Json{{"anyOf", {schema, {{"type", "null"}}}}};
    if (!schema["type"].is_array()) schema["type"] = Json::array({schema["type"], "null"});
    return schema;
}

Json object_schema(const std::vector<const FieldText*>& fields) {
    auto properties = Json::object();
    auto required = Json::array();
    for (const auto* field : fields) {
        auto property = field->is_nullable ? nullable(field->schema()) : field->schema();
        property["description"] = field->description;
        if (const auto* unit = unit_of_key(field->key)) property["unit"] = unit->unit;
        if (field->csv_column) property["csv"] = names_of(*field, *field->csv_column, "_");
        if (!field->in_json) property["csv_only"] = true;
        if (field->in_json && !field->is_optional) required.push_back(field->key);
        if (field->in_json || field->csv_column) properties[field->key] = std::move(property);
    }
    return {{"type", "object"},
            {"properties", std::move(properties)},
            {"required", std::move(required)},
            {"additionalProperties", false}};
}

TextTable text_table(const RecordRows& records) {
    TextTable table{{}, std::vector<std::vector<std::string>>(records.rows.size())};
    for (std::size_t column = 0; column < records.fields.size(); ++column) {
        const auto& field = *records.fields[column];
        const bool is_empty = std::ranges::all_of(records.rows, [&](const auto& row) { return row[column].is_null(); });
        if (field.is_hidden_if_empty && is_empty) continue;
        std::ranges::move(names_of(field, field.table_column.value(), " "), std::back_inserter(table.header));
        for (std::size_t i = 0; i < records.rows.size(); ++i)
            for_each_cell(field, records.rows[i][column],
                          [&](const Json& value) { table.rows[i].push_back(cell_text(value, field)); });
    }
    return table;
}

CsvWriter csv_header(const RecordRows& records, int digits) {
    std::vector<std::string> names;
    for (const auto* field : records.fields)
        std::ranges::move(names_of(*field, field->csv_column.value(), "_"), std::back_inserter(names));
    return CsvWriter(std::vector<std::string_view>(names.begin(), names.end()), digits);
}

std::string values_text(const Json& record, const std::string& prefix) {
    std::string text;
    for (const auto& [key, value] : record.items()) {
        const auto* unit = unit_of_key(key);
        auto label = prefix + key.substr(0, key.size() - (unit != nullptr ? unit->suffix.size() : 0));
        std::ranges::replace(label, '_', ' ');
        if (value.is_object())
            text += values_text(value, label + ' ');
        else if (!value.is_null() && !value.is_array())
            text += fmt::format("{}: {}{}\n", label, cell_text(value, {.key = key, .description = {}, .digits = ".4g"}),
                                unit != nullptr ? fmt::format(" {}", unit->unit) : "");
    }
    return text;
}

void add_csv_rows(const RecordRows& records, CsvWriter& csv) {
    for (const auto& row : records.rows) {
        std::vector<std::string> cells;
        for (std::size_t i = 0; i < row.size(); ++i)
            for_each_cell(*records.fields[i], row[i],
                          [&](const Json& value) { cells.push_back(csv_text(value, csv)); });
        csv.add_row(cells);
    }
}

}  // namespace flightwatt
