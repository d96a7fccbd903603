#include "telemetry/message_dictionary.h"

#include "base/atomic_file.h"
#include "base/number.h"
#include "telemetry/log_configuration.h"

#include <algorithm>
#include <charconv>
#include <utility>

namespace flightwatt::telemetry {
namespace {

/// "uint8", "float[3]", "char[]", "string".
std::optional<WireField> wire_field_of(std::string_view type) {
    if (type == "string") return WireField{WireType::text, WireCount::counted, 0};
    const auto bracket = type.find('[');
    const auto name = std::string(type.substr(0, bracket));
    const auto element = wire_type_of(name.find("int") == std::string::npos ? name : name + "_t");
    if (!element) return std::nullopt;
    if (bracket == std::string_view::npos) return WireField{*element, WireCount::one, 1};
    if (!type.ends_with(']')) return std::nullopt;
    const auto size = type.substr(bracket + 1, type.size() - bracket - 2);
    if (size.empty()) return WireField{*element, WireCount::counted, 0};
    const auto elements = parse_unsigned(size);
    if (!elements || *elements > 255) return std::nullopt;
    return WireField{*element, WireCount::fixed, static_cast<std::uint16_t>(*elements)};
}

/// Decimal, or hexadecimal behind 0x.
std::optional<std::uint8_t> byte_of(std::string_view text) {
    const int base = text.starts_with("0x") || text.starts_with("0X") ? 16 : 10;
    if (base == 16) text.remove_prefix(2);
    std::uint8_t value = 0;
    const auto* const end = text.data() + text.size();
    const auto read = std::from_chars(text.data(), end, value, base);
    return read.ec == std::errc() && read.ptr == end ? std::optional(value) : std::nullopt;
}

/// pprzlink's number of a class, for files before 2014, which have none.
std::optional<std::uint8_t> default_class_id(std::string_view name) {
    static constexpr std::string_view names[] = {"telemetry", "datalink", "ground", "alert", "intermcu"};
    const auto* const found = std::ranges::find(names, name);
    if (found == std::end(names)) return std::nullopt;
    return static_cast<std::uint8_t>(found - std::begin(names) + 1);
}

}  // namespace

std::string_view to_string(Framing framing) {
    switch (framing) {
        case Framing::card:
            return "SD card";
        case Framing::link:
            return "link";
        case Framing::xbee:
            break;
    }
    return "XBee";
}

std::string_view to_string(LinkVersion version) { return version == LinkVersion::v1 ? "pprzlink v1" : "pprzlink v2"; }

std::optional<WireType> wire_type_of(std::string_view name) {
    static constexpr std::pair<std::string_view, WireType> types[] = {
        {"int8_t", WireType::int8},     {"uint8_t", WireType::uint8},   {"int16_t", WireType::int16},
        {"uint16_t", WireType::uint16}, {"int32_t", WireType::int32},   {"uint32_t", WireType::uint32},
        {"int64_t", WireType::int64},   {"uint64_t", WireType::uint64}, {"float", WireType::float32},
        {"double", WireType::float64},  {"char", WireType::text}};
    const auto* const found = std::ranges::find(types, name, &std::pair<std::string_view, WireType>::first);
    return found == std::end(types) ? std::nullopt : std::optional(found->second);
}

bool WireMessage::fits_counted(std::string_view payload) const {
    std::size_t at = 0;
    for (const auto& field : fields) {
        std::size_t elements = field.elements;
        if (field.count == WireCount::counted) {
            if (at >= payload.size()) return false;
            elements = static_cast<unsigned char>(payload[at++]);
        }
        at += elements * size_of(field.type);
        if (at > payload.size()) return false;
    }
    return at == payload.size();
}

void MessageDictionary::add(std::string_view class_id, std::string_view class_name, std::string_view message_id,
                            const MessageDefinition& definition) {
    const auto group = class_id.empty() ? default_class_id(class_name) : byte_of(class_id);
    const auto id = byte_of(message_id);
    if (!group || *group >= max_classes || !id) return;
    auto& number = numbers_[*group * std::size_t{256} + *id];
    if (number != 0) return;
    WireMessage message{definition, *group, *id, {}, 0, false};
    for (const auto& field : definition.fields) {
        const auto wire = wire_field_of(field.type);
        if (!wire) return;
        message.fields.push_back(*wire);
        message.has_counted |= wire->count == WireCount::counted;
        message.fixed_bytes += wire->elements * size_of(wire->type);
    }
    messages_.push_back(std::move(message));
    number = static_cast<std::uint16_t>(messages_.size());
}

MessageDictionary parse_message_dictionary(const std::string& text, const std::filesystem::path& file) {
    MessageDictionary dictionary;
    for (const auto& message : parse_protocol(text, file))
        dictionary.add(message.class_id, message.class_name, message.id, message.definition);
    return dictionary;
}

MessageDictionary read_message_dictionary(const std::filesystem::path& path) {
    return parse_message_dictionary(read_file(path, max_log_configuration_bytes), path);
}

}  // namespace flightwatt::telemetry
