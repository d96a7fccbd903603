#pragma once

#include "base/statistics.h"

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

namespace flightwatt {

using Json = nlohmann::ordered_json;

template <typename R>
struct Field;
template <typename R>
using Fields = std::vector<Field<R>>;

/// An object whose keys are data: "takeoff", "cruise", "landing".
template <typename T>
using Keyed = std::vector<std::pair<std::string, T>>;

/// A record has a list of its fields: `Fields<R> record_fields(const R*)` in its namespace.
template <typename R>
concept Record = requires(const R* record) {
    record_fields(record);
};

/// An enumeration with a to_string().
template <typename T>
concept Named = std::is_enum_v<T> && requires(T value) {
    std::string(to_string(value));
};

template <Record R>
Json record_json(const R& record);
template <Record R>
void read_record(const Json& json, R& record);
template <Record R>
Json record_schema();

Json nullable(Json schema);

/// How a C++ type is written as JSON, described by JSON Schema and, where it `reads`, read back. Reading throws
/// std::exception for JSON of another type.
template <typename T>
struct JsonType {
    static constexpr bool reads =
        (Record<T> && std::is_default_constructible_v<T>) || std::is_arithmetic_v<T> || std::is_same_v<T, std::string>;

    static Json write(const T& value) {
        if constexpr (Record<T>)
            return record_json(value);
        else if constexpr (Named<T>)
            return std::string(to_string(value));
        else if constexpr (std::is_same_v<T, std::filesystem::path>)
            return value.string();
        else
            return value;
    }
    static Json schema() {
        if constexpr (Record<T>)
            return record_schema<T>();
        else if constexpr (std::is_same_v<T, Json>)
            return Json::object();
        else if constexpr (std::is_same_v<T, bool>)
            return {{"type", "boolean"}};
        else if constexpr (std::is_integral_v<T>)
            return {{"type", "integer"}};
        else
            return {{"type", std::is_floating_point_v<T> ? "number" : "string"}};
    }
    static void read(const Json& json, T& value) {
        if constexpr (Record<T>) {
            read_record(json, value);
        } else if constexpr (std::is_integral_v<T> && !std::is_same_v<T, bool>) {
            // get() would convert any number, and one beyond the type's range has no defined value.
            const bool fits = json.is_number_unsigned()  ? std::in_range<T>(json.get<std::uint64_t>())
                              : json.is_number_integer() ? std::in_range<T>(json.get<std::int64_t>())
                                                         : false;
            if (!fits) throw std::out_of_range("not a whole number of this type");
            value = json.get<T>();
        } else {
            json.get_to(value);
        }
    }
};

template <>
struct JsonType<Interval> {
    static constexpr bool reads = false;
    static Json write(const Interval& value) { return {{"low", value.low}, {"high", value.high}}; }
    static Json schema() {
        return {{"type", "object"},
                {"properties", {{"low", {{"type", "number"}}}, {"high", {{"type", "number"}}}}},
                {"required", {"low", "high"}},
                {"additionalProperties", false}};
    }
};

template <typename T>
struct JsonType<std::optional<T>> {
    static constexpr bool reads = JsonType<T>::reads;
    static Json write(const std::optional<T>& value) { return value ? JsonType<T>::write(*value) : Json(); }
    static Json schema() { return nullable(JsonType<T>::schema()); }
    static void read(const Json& json, std::optional<T>& value) {
        if (!json.is_null()) JsonType<T>::read(json, value.emplace());
    }
};

template <typename T>
struct JsonType<const T*> {
    static constexpr bool reads = false;
    static Json write(const T* value) { return value == nullptr ? Json() : JsonType<T>::write(*value); }
    static Json schema() { return nullable(JsonType<T>::schema()); }
};

template <typename T>
Json json_list(const auto& values) {
    auto list = Json::array();
    for (const auto& value : values) list.push_back(JsonType<T>::write(value));
    return list;
}

template <typename T>
struct JsonType<std::vector<T>> {
    static constexpr bool reads = JsonType<T>::reads;
    static Json write(const std::vector<T>& values) { return json_list<T>(values); }
    static Json schema() { return {{"type", "array"}, {"items", JsonType<T>::schema()}}; }
    static void read(const Json& json, std::vector<T>& values) {
        if (!json.is_array()) throw std::invalid_argument("not a list");
        values.reserve(json.size());
        for (const auto& entry : json) JsonType<T>::read(entry, values.emplace_back());
    }
};

template <typename T, std::size_t N>
struct JsonType<std::array<T, N>> {
    static constexpr bool reads = JsonType<T>::reads;
    static Json write(const std::array<T, N>& values) { return json_list<T>(values); }
    static Json schema() { return JsonType<std::vector<T>>::schema(); }
    static void read(const Json& json, std::array<T, N>& values) {
        for (std::size_t i = 0; i < N; ++i) JsonType<T>::read(json.at(i), values[i]);
    }
};

template <typename T>
Json keyed_json(const auto& values) {
    auto object = Json::object();
    for (const auto& [key, value] : values) object[key] = JsonType<T>::write(value);
    return object;
}

template <typename T>
struct JsonType<Keyed<T>> {
    static constexpr bool reads = false;
    static Json write(const Keyed<T>& values) { return keyed_json<T>(values); }
    static Json schema() { return {{"type", "object"}, {"additionalProperties", JsonType<T>::schema()}}; }
};

template <typename T>
struct JsonType<std::map<std::string, T>> {
    static constexpr bool reads = false;
    static Json write(const std::map<std::string, T>& values) { return keyed_json<T>(values); }
    static Json schema() { return JsonType<Keyed<T>>::schema(); }
};

}  // namespace flightwatt
