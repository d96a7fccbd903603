#include "telemetry/link_encoder.h"

#include "base/number.h"
#include "telemetry/binary/wire_value.h"
#include "telemetry/text/lines.h"

#include <algorithm>
#include <charconv>
#include <concepts>
#include <cstdint>
#include <limits>
#include <optional>
#include <type_traits>

namespace flightwatt::telemetry {
namespace {

template <typename Number>
std::optional<Number> parse_element(std::string_view word) {
    if constexpr (std::floating_point<Number>) {
        const bool is_nan = word == "nan" || word == "-nan";
        const auto number = is_nan ? std::numeric_limits<double>::quiet_NaN() : parse_number(word);
        return number ? std::optional(static_cast<Number>(*number)) : std::nullopt;
    } else {
        Number number = 0;
        const auto read = std::from_chars(word.data(), word.data() + word.size(), number);
        const bool is_whole = read.ec == std::errc() && read.ptr == word.data() + word.size();
        return is_whole ? std::optional(number) : std::nullopt;
    }
}

bool append_element(WireType type, std::string_view word, std::string& bytes) {
    return with_wire_type(type, [&]<typename T>() {
        if constexpr (std::is_same_v<T, char>) {
            if (word.size() == 1) bytes += word;
            return word.size() == 1;
        } else {
            const auto number = parse_element<T>(word);
            if (number) bytes += wire_bytes(*number);
            return number.has_value();
        }
    });
}

/// Removes a string: in " or |, or unquoted; the last field may contain blanks.
std::string_view take_string(std::string_view& text, bool is_last) {
    const char quote = text.empty() ? '\0' : text.front();
    if (quote == '"' || quote == '|') {
        if (const auto end = text.find(quote, 1); end != std::string_view::npos) {
            const auto word = text.substr(1, end - 1);
            text.remove_prefix(std::min(end + 2, text.size()));
            return word;
        }
    }
    if (!is_last) return take_word(text, ' ');
    const auto word = text;
    text = {};
    return word;
}

bool append_string(const WireField& field, std::string_view characters, std::string& bytes) {
    const std::size_t room =
        field.count == WireCount::fixed ? field.elements : std::numeric_limits<std::uint8_t>::max();
    if (characters.size() > room) return false;
    if (field.count == WireCount::counted) bytes += static_cast<char>(characters.size());
    bytes += characters;
    if (field.count == WireCount::fixed) bytes.append(room - characters.size(), '\0');
    return true;
}

bool append_field(const WireField& field, std::string_view& rest, bool is_last, std::string& bytes) {
    if (field.type == WireType::text && field.count != WireCount::one)
        return append_string(field, take_string(rest, is_last), bytes);
    auto words = take_word(rest, ' ');
    const auto elements =
        words.empty() ? 0U : static_cast<std::size_t>(std::count(words.begin(), words.end(), ',')) + 1;
    if (field.count == WireCount::counted) {
        if (elements > std::numeric_limits<std::uint8_t>::max()) return false;
        bytes += static_cast<char>(elements);
    } else if (elements != field.elements) {
        return false;
    }
    while (!words.empty()) {
        if (!append_element(field.type, take_word(words, ','), bytes)) return false;
    }
    return true;
}

bool append_fields(const WireMessage& message, std::string_view rest, std::string& bytes) {
    for (std::size_t i = 0; i < message.fields.size(); ++i) {
        if (!append_field(message.fields[i], rest, i + 1 == message.fields.size(), bytes)) return false;
    }
    return rest.find_first_not_of(" \r") == std::string_view::npos;
}

}  // namespace

LinkEncoder::LinkEncoder(const MessageDictionary& dictionary, LinkVersion version)
    : dictionary_(&dictionary), version_(version) {
    for (const auto& message : dictionary_->messages()) {
        if (message.class_id == MessageDictionary::telemetry_class) by_name_.emplace(message.definition.name, &message);
    }
}

std::string_view LinkEncoder::append_frame(std::string_view text, std::string& frames) {
    const auto sender = parse_element<std::uint8_t>(take_word(text, ' '));
    if (!sender) return "their sender is not an aircraft";
    const auto found = by_name_.find(take_word(text, ' '));
    if (found == by_name_.end()) return "their message is not defined";
    const auto& message = *found->second;
    payload_.assign(1, static_cast<char>(*sender));
    if (version_ == LinkVersion::v2) {
        payload_ += '\0';  // to all
        payload_ += static_cast<char>(message.class_id);
    }
    payload_ += static_cast<char>(message.id);
    if (!append_fields(message, text, payload_)) return "their fields do not match the definition";
    constexpr std::size_t around = 4;
    const auto length = payload_.size() + around;
    if (length > std::numeric_limits<std::uint8_t>::max()) return "they are too long for a frame";
    std::uint8_t a = static_cast<std::uint8_t>(length);
    std::uint8_t b = a;
    for (const char byte : payload_) {
        a = static_cast<std::uint8_t>(a + static_cast<std::uint8_t>(byte));
        b = static_cast<std::uint8_t>(b + a);
    }
    frames += '\x99';
    frames += static_cast<char>(length);
    frames += payload_;
    frames += static_cast<char>(a);
    frames += static_cast<char>(b);
    return {};
}

}  // namespace flightwatt::telemetry
