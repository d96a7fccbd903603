#include "telemetry/autopilot/dataflash.h"

#include "base/number.h"
#include "telemetry/binary/wire_value.h"
#include "telemetry/text/lines.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <utility>

namespace flightwatt::telemetry {
namespace {

constexpr std::string_view header = "\xA3\x95";
constexpr std::size_t header_bytes = 3;
constexpr std::uint8_t format_type = 128;
constexpr std::size_t format_bytes = 89;
constexpr std::size_t max_texts = 1000;
constexpr std::size_t max_parameters = 10'000;
constexpr double unknown_value = std::numeric_limits<double>::quiet_NaN();

/// Bytes of a field by its letter; 0 for an unknown letter.
std::size_t field_bytes(char code) {
    constexpr std::pair<std::string_view, std::size_t> sizes[] = {{"bBM", 1}, {"hHcCg", 2}, {"iIfneEL", 4},
                                                                  {"qQd", 8}, {"N", 16},    {"aZ", 64}};
    for (const auto& [codes, bytes] : sizes)
        if (codes.find(code) != std::string_view::npos) return bytes;
    return 0;
}

bool is_text_code(char code) { return code == 'n' || code == 'N' || code == 'Z' || code == 'a'; }

/// The factor that a field's letter has.
double factor_of(char code) {
    if (code == 'L') return 1e-7;
    return std::string_view("cCeE").find(code) == std::string_view::npos ? 1.0 : 0.01;
}

/// IEEE 754 with 16 bits.
double half_float(std::uint16_t bits) {
    const int exponent = bits >> 10 & 31;
    const int fraction = bits & 1023;
    if (exponent == 31) return unknown_value;
    const double magnitude = exponent == 0 ? std::ldexp(fraction, -24) : std::ldexp(fraction + 1024, exponent - 25);
    return (bits >> 15) != 0 ? -magnitude : magnitude;
}

double field_number(char code, const char* p) {
    switch (code) {
        case 'b':
            return wire_number<std::int8_t>(p);
        case 'B':
        case 'M':
            return wire_number<std::uint8_t>(p);
        case 'h':
        case 'c':
            return wire_number<std::int16_t>(p);
        case 'H':
        case 'C':
            return wire_number<std::uint16_t>(p);
        case 'i':
        case 'e':
        case 'L':
            return wire_number<std::int32_t>(p);
        case 'I':
        case 'E':
            return wire_number<std::uint32_t>(p);
        case 'q':
            return static_cast<double>(wire_number<std::int64_t>(p));
        case 'Q':
            return static_cast<double>(wire_number<std::uint64_t>(p));
        case 'f':
            return shortest_decimal(wire_number<float>(p));
        case 'd':
            return wire_number<double>(p);
        case 'g':
            return half_float(wire_number<std::uint16_t>(p));
        default:
            return unknown_value;
    }
}

std::string_view without_zeros(std::string_view text) { return text.substr(0, text.find('\0')); }

std::string_view trimmed(std::string_view text) {
    while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
    while (!text.empty() && (text.back() == ' ' || text.back() == '\r')) text.remove_suffix(1);
    return text;
}

/// A type of message, as FMT defines it.
struct DataflashFormat {
    std::string name;
    std::size_t length = 0;  ///< with the header; 0: the type is not defined
    bool is_usable = false;  ///< the fields fill the length
    std::string codes;
    std::vector<std::string> columns;
    std::vector<std::size_t> offsets;
    std::optional<std::size_t> clock;  ///< column of the time since boot
    double ticks_per_s = 1.0;
    std::size_t count = 0;
    std::optional<RowBinding<std::size_t>> binding;

    std::optional<std::size_t> index_of(std::string_view column) const {
        const auto found = std::ranges::find(columns, column);
        return found == columns.end() ? std::nullopt : std::optional(static_cast<std::size_t>(found - columns.begin()));
    }
    bool operator==(const DataflashFormat& other) const {
        return name == other.name && length == other.length && codes == other.codes && columns == other.columns;
    }
};

DataflashFormat make_format(std::string_view name, std::size_t length, std::string_view codes,
                            std::string_view columns) {
    DataflashFormat format{std::string(name), length, false, std::string(codes), {}, {}, {}, 1.0, 0, {}};
    while (!columns.empty()) format.columns.emplace_back(trimmed(take_word(columns, ',')));
    std::size_t offset = header_bytes;
    bool is_known = true;
    for (const char code : codes) {
        format.offsets.push_back(offset);
        offset += field_bytes(code);
        is_known = is_known && field_bytes(code) > 0;
    }
    const auto is_name = [](char c) { return c > ' ' && c <= '~'; };
    format.is_usable = is_known && offset == length && format.columns.size() == codes.size() && !name.empty() &&
                       std::ranges::all_of(name, is_name);
    const bool is_gps = name.starts_with("GPS");
    constexpr double ms_per_s = 1e3;
    constexpr double us_per_s = 1e6;
    for (const auto& [column, ticks] : {std::pair{"TimeUS", us_per_s}, {is_gps ? "T" : "TimeMS", ms_per_s}}) {
        if (format.clock) break;
        format.clock = format.index_of(column);
        format.ticks_per_s = ticks;
    }
    return format;
}

/// One message: the bytes with the header, or the values of a line.
struct DataflashMessage {
    const DataflashFormat& format;
    std::string_view bytes;
    const std::vector<std::string_view>* words = nullptr;

    double number(std::size_t column) const {
        const char code = format.codes[column];
        if (words != nullptr) return number_or_nan((*words)[column]);
        const double value = field_number(code, bytes.data() + format.offsets[column]);
        return std::isfinite(value) ? value * factor_of(code) : unknown_value;
    }
    std::string_view text(std::size_t column) const {
        if (words != nullptr) return (*words)[column];
        return without_zeros(bytes.substr(format.offsets[column], field_bytes(format.codes[column])));
    }
    std::optional<double> number(std::string_view column) const {
        const auto index = format.index_of(column);
        return index && !is_text_code(format.codes[*index]) ? std::optional(number(*index)) : std::nullopt;
    }
    std::string_view text(std::string_view column) const {
        const auto index = format.index_of(column);
        return index && (words != nullptr || is_text_code(format.codes[*index])) ? text(*index) : std::string_view();
    }
    /// A letter: its code, or as text itself.
    char letter(std::string_view column) const {
        const auto written = text(column);
        if (written.size() == 1 && number_or_nan(written) != number_or_nan(written)) return written.front();
        const double code = number(column).value_or(0.0);
        return code > 0.0 && code < 127.0 ? static_cast<char>(code) : '\0';
    }
};

/// The unit of ArduPilot's label, as the project names it.
std::optional<units::Unit> unit_of_label(std::string_view label) {
    constexpr std::pair<std::string_view, std::string_view> names[] = {{"W.s", "J"},
                                                                       {"W.h", "Wh"},
                                                                       {"Watt", "W"},
                                                                       {"deglatitude", "deg"},
                                                                       {"deglongitude", "deg"},
                                                                       {"degheading", "deg"},
                                                                       {"A.s", "2.7777777777777778e-4Ah"}};
    for (const auto& [theirs, ours] : names)
        if (theirs == label) return units::parse_unit(ours);
    return units::parse_unit(label);
}

class DataflashReader {
  public:
    explicit DataflashReader(RowCollector& rows) : rows_(rows), formats_(256) {
        formats_[format_type] = make_format("FMT", format_bytes, "BBnNZ", "Type,Length,Name,Format,Columns");
    }

    void read_binary(std::string_view bytes) {
        std::size_t at = 0;
        while (at < bytes.size()) {
            const auto size = message_bytes(bytes, at);
            if (size == 0) {
                const auto next = std::min(bytes.find(header, at + 1), bytes.size());
                rows_.skip(at, next - at);
                at = next;
                continue;
            }
            auto& format = formats_[static_cast<unsigned char>(bytes[at + 2])];
            ++format.count;
            const DataflashMessage message{format, bytes.substr(at, size)};
            if (&format == &formats_[format_type]) {
                define(static_cast<unsigned char>(bytes[at + 3]), static_cast<unsigned char>(bytes[at + 4]),
                       message.text(2), message.text(3), message.text(4));
            } else if (format.is_usable) {
                on_message(message, at);
            }
            at += size;
        }
    }

    void read_text(std::string_view text) {
        std::size_t line_index = 0;
        for_each_line(text, [&](std::string_view line) { read_line(line, line_index++); });
    }

    std::vector<AutopilotMessage> finish() {
        for (auto& table : rows_.end()) apply_units(table);
        std::vector<AutopilotMessage> messages;
        for (auto& format : formats_)
            if (format.length > 0) messages.push_back({format.name, format.count, format.columns});
        return messages;
    }

  private:
    /// Size of the message at a place; 0 if none begins there, or nothing that could be a message follows it.
    std::size_t message_bytes(std::string_view bytes, std::size_t at) const {
        const auto rest = bytes.substr(at);
        if (rest.size() < header_bytes || !rest.starts_with(header)) return 0;
        const auto size = formats_[static_cast<unsigned char>(rest[2])].length;
        if (size == 0 || size > rest.size()) return 0;
        const auto behind = rest.substr(size);
        if (behind.empty() || behind.starts_with(header)) return size;
        // The last page of a card is filled up.
        constexpr std::size_t page = 4096;
        const char fill = behind.front();
        const bool is_end = behind.size() < page && (fill == '\0' || fill == '\xFF') &&
                            behind.find_first_not_of(fill) == std::string_view::npos;
        return is_end || behind == header.substr(0, behind.size()) ? size : 0;
    }

    void define(std::size_t type, std::size_t length, std::string_view name, std::string_view codes,
                std::string_view columns) {
        if (type >= formats_.size() || type == format_type || length < header_bytes) return;
        auto format = make_format(name, length, codes, columns);
        auto& known = formats_[type];
        if (known == format || (known.is_usable && !format.is_usable)) return;
        format.count = known.count;
        known = std::move(format);
        has_formats_ = true;
        if (!known.is_usable) return;
        has_boot_clock_ = has_boot_clock_ || known.clock;
        known.binding =
            rows_.bind<std::size_t>(known.name, [&](const std::string& field) { return known.index_of(field); });
    }

    /// The message's own time, else that of the message before it; the oldest logs have a time in GPS messages alone.
    double time_of(const DataflashMessage& message) const {
        constexpr double ms_per_s = 1e3;
        if (message.format.clock) return message.number(*message.format.clock) / message.format.ticks_per_s;
        if (!has_boot_clock_ && message.format.name == "GPS") {
            for (const auto* column : {"TimeMS", "Time"}) {
                const double week_ms = message.number(std::string_view(column)).value_or(0.0);
                if (week_ms > 0.0) return week_ms / ms_per_s;
            }
        }
        return rows_.last_s();
    }

    void on_message(const DataflashMessage& message, std::size_t offset) {
        const auto& name = message.format.name;
        auto& facts = rows_.facts;
        if (name == "MSG" && facts.texts.size() < max_texts) {
            facts.texts.emplace_back(message.text("Message"));
        } else if (name == "PARM" && facts.parameters.size() < max_parameters) {
            if (const auto value = message.number("Value"))
                facts.parameters[std::string(message.text("Name"))] = *value;
        } else if (name == "UNIT") {
            labels_[message.letter("Id")] = message.text("Label");
        } else if (name == "MULT") {
            const auto multiplier = static_cast<float>(message.number("Mult").value_or(0.0));
            multipliers_[message.letter("Id")] = shortest_decimal(multiplier);
        } else if (name == "FMTU") {
            const double type = message.number("FmtType").value_or(-1.0);
            if (type >= 0.0 && type < static_cast<double>(formats_.size()))
                letters_[static_cast<std::size_t>(type)] = {std::string(message.text("UnitIds")),
                                                            std::string(message.text("MultIds"))};
        }
        if (!message.format.binding) return;
        rows_.add(*message.format.binding, time_of(message), offset,
                  [&](std::size_t column) { return message.number(column); });
    }

    void read_line(std::string_view line, std::size_t index) {
        constexpr std::size_t format_words = 4;
        auto rest = trimmed(line);
        if (rest.empty()) return;
        const auto name = take_word(rest, ',');
        words_.clear();
        if (name == "FMT") {
            while (words_.size() < format_words) words_.push_back(trimmed(take_word(rest, ',')));
            const auto type = parse_unsigned(words_[0]);
            const auto length = parse_unsigned(words_[1]);
            if (!type || !length) return rows_.skip(index, 1);
            return define(*type, *length, words_[2], words_[3], trimmed(rest));
        }
        const auto format = std::ranges::find(formats_, name, &DataflashFormat::name);
        if (name.empty() || format == formats_.end()) {
            if (has_formats_) rows_.skip(index, 1);
            return;
        }
        const auto columns = format->columns.size();
        while (!rest.empty() && words_.size() < columns) {
            const bool is_last = words_.size() + 1 == columns && is_text_code(format->codes.back());
            words_.push_back(trimmed(is_last ? std::exchange(rest, {}) : take_word(rest, ',')));
        }
        if (words_.size() + 1 == columns && is_text_code(format->codes.back())) words_.emplace_back();  // an empty one
        if (!format->is_usable || words_.size() != columns || !trimmed(rest).empty()) return rows_.skip(index, 1);
        ++format->count;
        on_message({*format, {}, &words_}, index);
    }

    void apply_units(MessageTable& table) const {
        const auto format = std::ranges::find_if(
            formats_, [&](const DataflashFormat& known) { return known.is_usable && known.name == table.message; });
        if (format == formats_.end()) return;
        const auto letters = letters_.find(static_cast<std::size_t>(format - formats_.begin()));
        for (auto& column : table.columns) {
            const auto index = format->index_of(column.field);
            if (!index) continue;
            const char code = format->codes[*index];
            column.is_integer = std::string_view("bBhHiIqQM").find(code) != std::string_view::npos;
            if (letters == letters_.end() || *index >= letters->second.first.size()) continue;
            const auto label = labels_.find(letters->second.first[*index]);
            const auto unit = label == labels_.end() ? std::nullopt : unit_of_label(label->second);
            if (!unit) continue;
            column.quantity = unit->quantity;
            const double factor = unit->factor * (factor_of(code) == 1.0 ? multiplier(letters->second, *index) : 1.0);
            if (factor != 1.0)
                for (auto& value : column.values) value *= factor;
        }
    }

    double multiplier(const std::pair<std::string, std::string>& letters, std::size_t index) const {
        const auto found =
            index < letters.second.size() ? multipliers_.find(letters.second[index]) : multipliers_.end();
        return found == multipliers_.end() || found->second == 0.0 ? 1.0 : found->second;
    }

    RowCollector& rows_;
    std::vector<DataflashFormat> formats_;  ///< by type
    bool has_formats_ = false;              ///< before, a text has a preamble
    bool has_boot_clock_ = false;
    std::map<char, std::string> labels_;
    std::map<char, double> multipliers_;
    std::map<std::size_t, std::pair<std::string, std::string>> letters_;  ///< of units and multipliers, by type
    std::vector<std::string_view> words_;
};

}  // namespace

bool is_dataflash(std::string_view bytes) {
    constexpr std::string_view first = "\xA3\x95\x80";
    for (auto at = bytes.find(first); at != std::string_view::npos; at = bytes.find(first, at + 1)) {
        const auto behind = bytes.substr(std::min(at + format_bytes, bytes.size()));
        if (at == 0 || behind.starts_with(header)) return true;
    }
    return false;
}

std::vector<AutopilotMessage> read_dataflash(std::string_view bytes, bool as_text, RowCollector& rows) {
    DataflashReader reader(rows);
    if (as_text)
        reader.read_text(bytes);
    else
        reader.read_binary(bytes);
    return reader.finish();
}

}  // namespace flightwatt::telemetry
