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

/// Type of a field by its letter; a text has many characters.
struct FieldLetters {
    std::string_view letters;
    WireType type;
    std::size_t elements = 1;
};

constexpr FieldLetters field_letters[] = {
    {"b", WireType::int8},      {"BM", WireType::uint8},  {"hc", WireType::int16},  {"HC", WireType::uint16},
    {"ieL", WireType::int32},   {"IE", WireType::uint32}, {"q", WireType::int64},   {"Q", WireType::uint64},
    {"f", WireType::float32},   {"d", WireType::float64}, {"n", WireType::text, 4}, {"N", WireType::text, 16},
    {"Za", WireType::text, 64}, {"g", WireType::text, 2},  // arrays and half floats are not read as numbers
};

double factor_of(char letter) {
    if (letter == 'L') return 1e-7;
    return std::string_view("cCeE").find(letter) == std::string_view::npos ? 1.0 : 0.01;
}

std::string_view trimmed(std::string_view text) {
    while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
    while (!text.empty() && (text.back() == ' ' || text.back() == '\r')) text.remove_suffix(1);
    return text;
}

/// A type of message, as FMT defines it.
struct DataflashFormat : LoggedMessage {
    bool is_usable = false;  ///< the fields fill the length
    std::string letters = {};
    std::string columns = {};

    bool ends_in_text() const { return !fields.empty() && fields.back().type == WireType::text; }
};

DataflashFormat make_format(std::string_view name, std::size_t length, std::string_view letters,
                            std::string_view columns) {
    DataflashFormat format;
    format.name = name;
    format.bytes = length;
    format.letters = letters;
    format.columns = columns;
    std::size_t offset = header_bytes;
    const auto is_name = [](char c) { return c > ' ' && c <= '~'; };
    bool is_known = !name.empty() && std::ranges::all_of(name, is_name);
    for (const char letter : letters) {
        const auto* const found = std::ranges::find_if(field_letters, [&](const FieldLetters& known) {
            return known.letters.find(letter) < known.letters.size();
        });
        is_known = is_known && found != std::end(field_letters) && !columns.empty();
        if (!is_known) break;
        format.fields.push_back(
            {std::string(trimmed(take_word(columns, ','))), offset, found->type, factor_of(letter)});
        offset += found->elements * size_of(found->type);
    }
    format.is_usable = is_known && offset == length && columns.empty();
    constexpr double ms_per_s = 1e3;
    constexpr double us_per_s = 1e6;
    for (const auto& [column, ticks] :
         {std::pair{"TimeUS", us_per_s}, {name.starts_with("GPS") ? "T" : "TimeMS", ms_per_s}}) {
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

    double number(std::size_t field) const {
        return words != nullptr ? number_or_nan((*words)[field]) : format.fields[field].number(bytes);
    }
    /// NaN for a text, and for a field that the format lacks.
    double number(std::string_view field) const {
        const auto index = format.index_of(field);
        return index ? number(*index) : std::numeric_limits<double>::quiet_NaN();
    }
    std::string_view text(std::string_view field) const {
        const auto index = format.index_of(field);
        if (!index) return {};
        if (words != nullptr) return (*words)[*index];
        const auto from = bytes.substr(format.fields[*index].offset);
        const bool is_last = *index + 1 == format.fields.size();
        const auto size = is_last ? from.size() : format.fields[*index + 1].offset - format.fields[*index].offset;
        const auto text = from.substr(0, size);
        return text.substr(0, text.find('\0'));
    }
    /// A letter: its code, or as text itself.
    char letter(std::string_view field) const {
        const double code = number(field);
        if (code > 0.0 && code < 127.0) return static_cast<char>(code);
        const auto written = words == nullptr ? std::string_view() : text(field);
        return written.size() == 1 ? written.front() : '\0';
    }
};

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
                       message.text("Name"), message.text("Format"), message.text("Columns"));
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

    void finish() {
        for (auto& table : rows_.end()) apply_units(table);
        for (const auto& format : formats_) rows_.list(format);
    }

  private:
    /// Size of the message at a place; 0 if none begins there, or nothing that could be a message follows it.
    std::size_t message_bytes(std::string_view bytes, std::size_t at) const {
        const auto rest = bytes.substr(at);
        if (rest.size() < header_bytes || !rest.starts_with(header)) return 0;
        const auto size = formats_[static_cast<unsigned char>(rest[2])].bytes;
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

    void define(std::size_t type, std::size_t length, std::string_view name, std::string_view letters,
                std::string_view columns) {
        if (type >= formats_.size() || type == format_type || length < header_bytes) return;
        auto& known = formats_[type];
        if (known.name == name && known.bytes == length && known.letters == letters && known.columns == columns) return;
        auto format = make_format(name, length, letters, columns);
        if (known.is_usable && !format.is_usable) return;
        rows_.list(known);
        known = std::move(format);
        has_formats_ = true;
        has_boot_clock_ = has_boot_clock_ || (known.is_usable && known.clock);
        if (known.is_usable) rows_.bind(known);
    }

    /// The message's own time, else that of the message before it; the oldest logs have a time in GPS messages alone.
    double time_of(const DataflashMessage& message) const {
        constexpr double ms_per_s = 1e3;
        if (message.format.clock) return message.number(*message.format.clock) / message.format.ticks_per_s;
        if (!has_boot_clock_ && message.format.name == "GPS")
            for (const auto* field : {"TimeMS", "Time"})
                if (const double week_ms = message.number(field); week_ms > 0.0) return week_ms / ms_per_s;
        return rows_.last_s();
    }

    void on_message(const DataflashMessage& message, std::size_t offset) {
        constexpr std::size_t max_texts = 1000;
        constexpr std::size_t max_parameters = 10'000;
        const auto& name = message.format.name;
        auto& facts = rows_.facts();
        if (name == "MSG" && facts.texts.size() < max_texts) {
            facts.texts.emplace_back(message.text("Message"));
        } else if (name == "PARM" && facts.parameters.size() < max_parameters) {
            facts.parameters[std::string(message.text("Name"))] = message.number("Value");
        } else if (name == "UNIT") {
            labels_[message.letter("Id")] = message.text("Label");
        } else if (name == "MULT") {
            multipliers_[message.letter("Id")] = shortest_decimal(static_cast<float>(message.number("Mult")));
        } else if (name == "FMTU") {
            const double type = message.number("FmtType");
            if (type >= 0.0 && type < static_cast<double>(formats_.size()))
                unit_letters_[static_cast<std::size_t>(type)] = {std::string(message.text("UnitIds")),
                                                                 std::string(message.text("MultIds"))};
        }
        rows_.add(message.format, time_of(message), offset, [&](std::size_t field) { return message.number(field); });
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
        const auto format = std::ranges::find(formats_, name, &LoggedMessage::name);
        if (name.empty() || format == formats_.end()) {
            if (has_formats_) rows_.skip(index, 1);
            return;
        }
        const auto columns = format->fields.size();
        while (!rest.empty() && words_.size() < columns) {
            const bool is_last = words_.size() + 1 == columns && format->ends_in_text();
            words_.push_back(trimmed(is_last ? std::exchange(rest, {}) : take_word(rest, ',')));
        }
        if (words_.size() + 1 == columns && format->ends_in_text()) words_.emplace_back();  // an empty one
        if (!format->is_usable || words_.size() != columns || !trimmed(rest).empty()) return rows_.skip(index, 1);
        ++format->count;
        on_message({*format, {}, &words_}, index);
    }

    /// Converts the columns whose unit the log states.
    void apply_units(MessageTable& table) const {
        const auto format = std::ranges::find_if(
            formats_, [&](const DataflashFormat& known) { return known.is_usable && known.name == table.message; });
        if (format == formats_.end()) return;
        const auto letters = unit_letters_.find(static_cast<std::size_t>(format - formats_.begin()));
        if (letters == unit_letters_.end()) return;
        const auto& [unit_ids, multiplier_ids] = letters->second;
        for (auto& column : table.columns) {
            const auto index = format->index_of(column.field);
            if (!index || *index >= unit_ids.size()) continue;
            const auto label = labels_.find(unit_ids[*index]);
            const auto unit = label == labels_.end() ? std::nullopt : units::parse_unit(label->second);
            if (!unit) continue;
            column.quantity = unit->quantity;
            double factor = unit->factor;
            if (format->fields[*index].factor == 1.0 && *index < multiplier_ids.size())
                if (const auto known = multipliers_.find(multiplier_ids[*index]);
                    known != multipliers_.end() && known->second > 0.0)
                    factor *= known->second;
            if (factor != 1.0)
                for (auto& value : column.values) value *= factor;
        }
    }

    RowCollector& rows_;
    std::vector<DataflashFormat> formats_;  ///< by type
    bool has_formats_ = false;              ///< before, a text has a preamble
    bool has_boot_clock_ = false;
    std::map<char, std::string> labels_;
    std::map<char, double> multipliers_;
    std::map<std::size_t, std::pair<std::string, std::string>> unit_letters_;  ///< and of multipliers, by type
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

void read_dataflash(std::string_view bytes, bool as_text, RowCollector& rows) {
    DataflashReader reader(rows);
    if (as_text)
        reader.read_text(bytes);
    else
        reader.read_binary(bytes);
    reader.finish();
}

}  // namespace flightwatt::telemetry
