#include "telemetry/autopilot/ulog.h"

#include "base/error.h"
#include "base/number.h"
#include "telemetry/binary/wire_value.h"
#include "telemetry/text/lines.h"

#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>

namespace flightwatt::telemetry {
namespace {

using namespace std::string_view_literals;

constexpr auto magic = "ULog\x01\x12\x35"sv;
constexpr auto instance_field = "multi_id"sv;
constexpr std::size_t file_header_bytes = 16;
constexpr std::size_t ulog_header_bytes = 3;
constexpr std::size_t max_message_bytes = 10'000;  // the topics of real logs have up to some 1,500
constexpr std::size_t max_information_bytes = 65'535;
constexpr std::size_t max_entries = 10'000;  // of formats, parameters, texts
constexpr std::size_t max_nesting = 8;
constexpr std::size_t max_topic_fields = 200'000;  // of all topics
constexpr std::size_t confirming_headers = 3;      // in a row, to continue behind damage

/// A field of a format, whose type may be another format.
struct UlogField {
    std::string type;
    std::size_t elements = 1;
    std::string name;
    bool is_array = false;  ///< "float[1] control" is one too
};

std::optional<WireType> ulog_type_of(std::string_view name) {
    return name == "bool" ? WireType::uint8 : wire_type_of(name);
}

/// "float[3] xyz"; std::nullopt if it is no field.
std::optional<UlogField> field_of(std::string_view text) {
    const auto type = take_word(text);
    const auto bracket = type.find('[');
    UlogField field{std::string(type.substr(0, bracket)), 1, std::string(text)};
    if (bracket != std::string_view::npos) {
        const auto elements = parse_unsigned(type.substr(bracket + 1, type.size() - bracket - 2));
        if (!type.ends_with(']') || !elements || *elements == 0 || *elements > max_message_bytes) return std::nullopt;
        field.elements = *elements;
        field.is_array = true;
    }
    if (field.type.empty() || field.name.empty()) return std::nullopt;
    return field;
}

std::optional<UlogField> key_and_value(std::string_view body, std::string_view& value) {
    if (body.empty()) return std::nullopt;
    const std::size_t size = static_cast<unsigned char>(body.front());
    if (body.size() < 1 + size) return std::nullopt;
    value = body.substr(1 + size);
    return field_of(body.substr(1, size));
}

class UlogReader {
  public:
    UlogReader(std::string_view bytes, RowCollector& rows) : bytes_(bytes), rows_(rows) {}

    void read() {
        std::size_t at = file_header_bytes;
        while (at < bytes_.size()) {
            if (is_ulog(bytes_.substr(at))) {  // of a log that was appended
                at += file_header_bytes;
                continue;
            }
            const auto part_end = end_of_part(at);
            const auto size = message_bytes(at, part_end);
            if (size > 0) {
                on_message(bytes_[at + 2], bytes_.substr(at + ulog_header_bytes, size - ulog_header_bytes), at);
                at += size;
                continue;
            }
            auto next = at + 1;
            while (next < part_end && !is_chain(next, part_end)) ++next;
            next = std::min(next, part_end);
            rows_.skip(at, next - at);
            at = next;
        }
    }

    void list() const {
        for (const auto& [name, topic] : topics_) rows_.list(topic);
    }

  private:
    /// A log that was closed after a crash has further parts at known places; the part before may be cut.
    std::size_t end_of_part(std::size_t at) const {
        const auto next = std::ranges::upper_bound(appended_, at);
        return next == appended_.end() ? bytes_.size() : std::min(*next, bytes_.size());
    }

    static std::size_t max_bytes_of(char kind) {
        return kind == 'M' || kind == 'I' ? max_information_bytes : max_message_bytes;
    }

    /// Size of the message whose header is at a place; 0 if none is there, or it is cut off.
    std::size_t header_size(std::size_t at, std::size_t end) const {
        if (end - at < ulog_header_bytes) return 0;
        const std::size_t size = wire_number<std::uint16_t>(bytes_.data() + at);
        const char kind = bytes_[at + 2];
        const bool is_kind = "BFIMPQARDLCOS"sv.find(kind) != std::string_view::npos;
        return is_kind && size > 0 && size <= max_bytes_of(kind) && size <= end - at - ulog_header_bytes
                   ? ulog_header_bytes + size
                   : 0;
    }

    /// The same, if another header or the end follows. Kinds of newer logs (any letter) are passed over.
    std::size_t message_bytes(std::size_t at, std::size_t end) const {
        if (end - at < ulog_header_bytes) return 0;
        const std::size_t size = wire_number<std::uint16_t>(bytes_.data() + at) + ulog_header_bytes;
        const auto is_letter = [&](std::size_t place) { return bytes_[place] >= 'A' && bytes_[place] <= 'Z'; };
        if (!is_letter(at + 2) || size == ulog_header_bytes || size > end - at) return 0;
        if (size - ulog_header_bytes > max_bytes_of(bytes_[at + 2])) return 0;
        const auto behind = at + size;
        if (end - behind < ulog_header_bytes || is_ulog(bytes_.substr(behind))) return size;
        const bool follows = is_letter(behind + 2) && wire_number<std::uint16_t>(bytes_.data() + behind) > 0;
        return follows ? size : 0;
    }

    bool is_chain(std::size_t at, std::size_t end) const {
        for (std::size_t i = 0; i < confirming_headers && at < end; ++i) {
            const auto size = header_size(at, end);
            if (size == 0) return false;
            at += size;
        }
        return at <= end;
    }

    void on_message(char kind, std::string_view body, std::size_t offset) {
        switch (kind) {
            case 'B':
                return read_flags(body);
            case 'F':
                return read_format(body);
            case 'I':
                return read_key(body, false);
            case 'P':
                return read_key(body, true);
            case 'A':
                return subscribe(body);
            case 'D':
                return read_data(body, offset);
            case 'L': {
                constexpr std::size_t text_offset = 9;
                if (body.size() > text_offset && rows_.facts().texts.size() < max_entries)
                    rows_.facts().texts.emplace_back(body.substr(text_offset));
                return;
            }
            case 'O':
                if (body.size() < 2) return;
                ++rows_.facts().dropouts;
                rows_.facts().dropout_s += wire_number<std::uint16_t>(body.data()) / 1e3;
                return;
            default:
                return;
        }
    }

    void read_flags(std::string_view body) {
        constexpr std::size_t flag_bytes = 8;
        constexpr std::size_t flags_end = 2 * flag_bytes;
        constexpr unsigned known = 1;  // data are appended
        if (body.size() < flags_end) return;
        for (std::size_t i = 0; i < flag_bytes; ++i) {
            const unsigned flags = static_cast<unsigned char>(body[flag_bytes + i]);
            if ((flags & ~(i == 0 ? known : 0U)) == 0) continue;
            throw InputError(
                {rows_.file().string()},
                fmt::format("has features of a newer ULog (incompatible flags {:#x} in byte {})", flags, i),
                "this version of FlightWatt cannot read them");
        }
        for (auto at = flags_end; at + sizeof(std::uint64_t) <= body.size(); at += sizeof(std::uint64_t)) {
            const auto offset = wire_number<std::uint64_t>(body.data() + at);
            if (offset > file_header_bytes && offset < bytes_.size()) appended_.push_back(offset);
        }
        std::ranges::sort(appended_);
    }

    void read_format(std::string_view body) {
        auto fields = body;
        const auto name = std::string(take_word(fields, ':'));
        std::vector<UlogField> read;
        while (!fields.empty()) {
            const auto field = field_of(take_word(fields, ';'));
            if (!field) return;
            read.push_back(*field);
        }
        if (!name.empty() && !read.empty() && formats_.size() < max_entries) formats_.emplace(name, std::move(read));
    }

    /// Information, as text, or a parameter.
    void read_key(std::string_view body, bool is_parameter) {
        constexpr std::size_t max_text = 200;
        std::string_view value;
        const auto key = key_and_value(body, value);
        auto& information = rows_.facts().information;
        auto& parameters = rows_.facts().parameters;
        if (!key || information.size() + parameters.size() >= max_entries) return;
        const auto type = ulog_type_of(key->type);
        const bool is_number = type && key->elements == 1 && value.size() == size_of(*type);
        if (is_number && is_parameter) parameters.emplace(key->name, wire_value(*type, value.data()));
        if (key->type == "char" && !is_parameter) information.emplace(key->name, value.substr(0, max_text));
    }

    /// Adds the fields of a type, also of nested ones; false if it is unknown, nested too deeply, or too large.
    bool add_fields(const std::string& type, const std::string& prefix, std::size_t depth, LoggedMessage& topic) {
        const auto format = formats_.find(type);
        if (format == formats_.end() || depth > max_nesting) return false;
        for (const auto& field : format->second) {
            const auto basic = ulog_type_of(field.type);
            for (std::size_t i = 0; i < field.elements; ++i) {
                auto name = prefix + (field.is_array ? fmt::format("{}[{}]", field.name, i) : field.name);
                if (!basic && !add_fields(field.type, name + ".", depth + 1, topic)) return false;
                if (!basic) continue;
                topic.fields.push_back({std::move(name), topic.bytes, *basic});
                topic.bytes += size_of(*basic);
                if (topic.bytes > max_message_bytes || ++fields_ > max_topic_fields) return false;
            }
        }
        return true;
    }

    void subscribe(std::string_view body) {
        if (body.size() < 4) return;
        const auto id = wire_number<std::uint16_t>(body.data() + 1);
        subscriptions_[id] = {topic_of(std::string(body.substr(3))),
                              static_cast<double>(static_cast<std::uint8_t>(body[0]))};
    }

    /// A topic, at its first subscription; nullptr if its format is not defined. One that cannot be read has no clock.
    LoggedMessage* topic_of(const std::string& name) {
        if (!formats_.contains(name)) return nullptr;
        const auto [known, is_new] = topics_.try_emplace(name);
        auto& topic = known->second;
        if (!is_new) return &topic;
        topic.name = name;
        topic.fields.push_back({std::string(instance_field), 0, WireType::uint8});
        const bool is_readable = add_fields(name, "", 0, topic);
        while (topic.fields.back().name.starts_with("_padding")) topic.fields.pop_back();  // not always written
        topic.clock = topic.index_of("timestamp");
        if (!is_readable || (topic.clock && topic.fields[*topic.clock].type != WireType::uint64)) topic.clock.reset();
        rows_.bind(topic);
        return &topic;
    }

    void read_data(std::string_view body, std::size_t offset) {
        if (body.size() < 2) return rows_.skip(offset, body.size() + ulog_header_bytes);
        const auto found = subscriptions_.find(wire_number<std::uint16_t>(body.data()));
        if (found == subscriptions_.end() || found->second.first == nullptr) return;
        auto& topic = *found->second.first;
        const double multi_id = found->second.second;
        const auto data = body.substr(2);
        if (!topic.clock) return;
        const auto& last = topic.fields.back();
        if (data.size() != topic.bytes && data.size() != last.offset + size_of(last.type))
            return rows_.skip(offset, body.size() + ulog_header_bytes);
        ++topic.count;
        const double time_us = topic.fields[*topic.clock].number(data);
        if (time_us == 0.0) return;  // never published
        rows_.add(topic, time_us / topic.ticks_per_s, offset,
                  [&](std::size_t field) { return field == 0 ? multi_id : topic.fields[field].number(data); });
    }

    std::string_view bytes_;
    RowCollector& rows_;
    std::vector<std::size_t> appended_;
    std::map<std::string, std::vector<UlogField>> formats_;
    std::map<std::string, LoggedMessage> topics_;
    std::size_t fields_ = 0;
    std::map<std::uint16_t, std::pair<LoggedMessage*, double>> subscriptions_;  ///< with the instance
};

}  // namespace

bool is_ulog(std::string_view bytes) { return bytes.starts_with(magic); }

void read_ulog(std::string_view bytes, RowCollector& rows) {
    UlogReader reader(bytes, rows);
    reader.read();
    reader.list();
}

}  // namespace flightwatt::telemetry
